#include "roadbed/tools/audit/audit_all.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>

#include "roadbed/map/files/in_threads.h"
#include "roadbed/planning/audit/vehicle_audit.h"
#include "roadbed/tools/audit/drive_groups.h"

namespace roadbed::tools::inline audit {
namespace {

using planning::VehicleSurroundings;

class ManyAudits {
 public:
  ManyAudits(const AuditDemand& demand, const std::vector<AuditSubject>& subjects, int threads,
             const std::function<void()>& done_one)
      : demand_(demand), threads_(threads), done_one_(done_one), audited_(subjects.size()) {
    map::in_threads(subjects.size(), threads, [&](std::size_t i) {
      audited_[i].name = subjects[i].name;
      audited_[i].has_occupancy = demand.occupancy != nullptr;
      attempt(i, [&] { read(subjects[i], audited_[i]); });
      if (!is_usable(i)) done_one_();
    });
  }

  std::vector<AuditedDrive> run() {
    if (demand_.occupancy != nullptr) {
      audit_in_occupancy();
    } else {
      map::in_threads(audited_.size(), threads_, [&](std::size_t i) {
        if (is_usable(i)) finish(i, [] {});
      });
    }
    return std::move(audited_);
  }

 private:
  bool is_usable(std::size_t i) const { return audited_[i].fault.empty(); }

  template <typename Work>
  void attempt(std::size_t i, const Work& work) {
    try {
      work();
    } catch (const std::exception& error) {
      audited_[i].fault = error.what();
    }
  }

  void read(const AuditSubject& subject, AuditedDrive& audited) const {
    audited.take(subject.read());
    if (demand_.occupancy == nullptr) return;
    audited.audit.ground = demand_.question.ground_of(*demand_.occupancy, audited.drive);
  }

  // Groups follow each other, as each may take all the memory that there is for fields.
  void audit_in_occupancy() {
    std::vector<DriveGroup> apart;
    for (DriveGroup& group : drive_groups(extents(), demand_.occupancy->resolution_m())) {
      if (group.drives.size() > 1) {
        audit_together(group);
      } else {
        apart.push_back(std::move(group));
      }
    }
    audit_apart(std::move(apart));
  }

  std::vector<DriveExtent> extents() const {
    const planning::AuditQuestion& question = demand_.question;
    std::vector<DriveExtent> extents;
    for (std::size_t i = 0; i < audited_.size(); ++i) {
      if (!is_usable(i)) continue;
      extents.push_back(
          {i, audited_[i].audit.ground,
           planning::audited_region(audited_[i].drive, question.parts, question.options)});
    }
    return extents;
  }

  VehicleSurroundings surroundings(const DriveGroup& group) const {
    return {*demand_.occupancy, group.ground, demand_.question.parts, group.region};
  }

  void audit_together(const DriveGroup& group) {
    std::optional<VehicleSurroundings> around;
    std::exception_ptr fault;
    try {
      around = surroundings(group);
    } catch (const std::exception&) {
      fault = std::current_exception();  // of each of the drives
    }
    map::in_threads(group.drives.size(), threads_, [&](std::size_t k) {
      finish(group.drives[k], [&] {
        if (fault) std::rethrow_exception(fault);
        audit(group.drives[k], *around);
      });
    });
  }

  void audit_apart(std::vector<DriveGroup> groups) {
    const std::size_t at_once =
        std::clamp<std::size_t>(groups.size(), 1, static_cast<std::size_t>(std::max(1, threads_)));
    map::in_threads(groups.size(), threads_, [&](std::size_t k) {
      DriveGroup& group = groups[k];
      group.region.most_cells /= at_once;
      finish(group.drives.front(), [&] { audit(group.drives.front(), surroundings(group)); });
    });
  }

  void audit(std::size_t i, const VehicleSurroundings& around) {
    AuditedDrive& one = audited_[i];
    one.audit = planning::audit_drive(around, one.audit.ground, one.drive, demand_.question);
  }

  template <typename AuditInOccupancy>
  void finish(std::size_t i, const AuditInOccupancy& audit_in_occupancy) {
    attempt(i, [&] {
      audit_in_occupancy();
      finish_audit(demand_, audited_[i]);
    });
    done_one_();
  }

  const AuditDemand& demand_;
  int threads_;
  const std::function<void()>& done_one_;
  std::vector<AuditedDrive> audited_;
};

}  // namespace

std::vector<AuditedDrive> audit_all(const AuditDemand& demand,
                                    const std::vector<AuditSubject>& subjects, int threads,
                                    const std::function<void()>& done_one) {
  return ManyAudits(demand, subjects, threads, done_one).run();
}

}  // namespace roadbed::tools::audit
