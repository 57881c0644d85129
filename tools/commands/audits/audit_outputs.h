#pragma once

#include <filesystem>
#include <vector>

#include "roadbed/tools/audit/audit_subjects.h"
#include "roadbed/tools/audit/audited_drive.h"
#include "roadbed/tools/cli/arguments.h"
#include "roadbed/tools/commands/audits/audit_asked.h"
#include "roadbed/tools/commands/audits/audit_scene.h"

namespace roadbed::tools::inline commands::inline audits {

/// The files that an audit writes.
class AuditOutputs {
 public:
  /// @returns what --check does not go with.
  std::vector<Argument> declare(Arguments& arguments);
  void declare_force(Arguments& arguments);

  bool certifies() const { return !certificate_.empty(); }
  bool saves_drive() const { return !saved_drive_.empty(); }
  bool saves_occupancy() const { return !saved_occupancy_.empty(); }
  bool saves_obstacles() const { return !saved_obstacles_.empty(); }

  /// Checks that all can be written, and that a certificate can be about its files.
  /// @throws OutputError, InputError
  void check(const AuditAsked& asked, const AuditSubjects& subjects) const;

  /// @throws InputError if a certificate would be about obstacles at other times than their file
  ///         says. @pre `asked` has taken the drive.
  void check_clock(const AuditAsked& asked) const;

  /// @throws InputError if an output is about one drive.
  void check_for_folder() const;

  void write_one(const AuditedDrive& audited, const AuditScene& scene) const;
  void write_all(const std::vector<AuditedDrive>& audits, const AuditScene& scene) const;

 private:
  void write_saved(const AuditedDrive& audited, const AuditScene& scene) const;
  void write_picture(const AuditedDrive& audited, const AuditScene& scene) const;
  void write_report(const AuditedDrive& audited, const AuditScene& scene) const;
  void write_log(const AuditedDrive& audited, const AuditScene& scene) const;
  void write_index(const std::vector<AuditedDrive>& audits, const AuditScene& scene) const;
  void write_certificate(const AuditedDrive& audited, const AuditScene& scene) const;
  void write_lists(const std::vector<AuditedDrive>& audits, const AuditScene& scene) const;

  std::filesystem::path svg_, report_, mcap_, certificate_, junit_, geojson_, saved_drive_,
      saved_occupancy_, saved_obstacles_;
  bool force_ = false;
};

}  // namespace roadbed::tools::commands::audits
