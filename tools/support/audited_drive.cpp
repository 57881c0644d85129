#include "roadbed/tools/support/audited_drive.h"

#include <exception>

#include "roadbed/tools/support/in_threads.h"

namespace roadbed::tools {
namespace {

AuditedDrive audit_one(const map::OccupancyMap& occupancy, const AuditSubject& subject,
                       const AuditQuestion& question) {
  AuditedDrive audited{.name = subject.name};
  try {
    audited.drive = subject.drive();
    const map::ClearanceField field(
        occupancy, question.band,
        planning::audited_region(audited.drive, question.vehicle, question.options));
    audited.report =
        planning::audit(field, audited.drive, question.vehicle, question.options, question.moving);
  } catch (const std::exception& error) {
    audited.fault = error.what();
  }
  return audited;
}

}  // namespace

std::vector<AuditedDrive> audit_all(const map::OccupancyMap& occupancy,
                                    const std::vector<AuditSubject>& subjects,
                                    const AuditQuestion& question, int threads,
                                    const std::function<void()>& done_one) {
  std::vector<AuditedDrive> audited(subjects.size());
  in_threads(subjects.size(), threads, [&](std::size_t i) {
    audited[i] = audit_one(occupancy, subjects[i], question);
    done_one();
  });
  return audited;
}

}  // namespace roadbed::tools
