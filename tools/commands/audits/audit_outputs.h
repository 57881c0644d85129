#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/audit/audit_subjects.h"
#include "roadbed/tools/audit/audited_drive.h"
#include "roadbed/tools/audit/certified_file.h"
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

  /// All that was asked for of one drive, or nothing.
  /// @throws InputError, OutputError
  void write_one(const AuditedDrive& audited, const AuditScene& scene) const;
  /// The same of a folder's.
  void write_all(const std::vector<AuditedDrive>& audits, const AuditScene& scene) const;

 private:
  // Inputs of the audit that are outputs, too; none where they are not asked for.
  struct Saved {
    std::optional<CertifiedFile> drive, occupancy;
  };

  Saved add_saved(const AuditedDrive& audited, const AuditScene& scene,
                  map::OutputFiles& files) const;
  std::string picture(const AuditedDrive& audited, const AuditScene& scene) const;
  std::string index(const std::vector<AuditedDrive>& audits, const AuditScene& scene) const;
  std::string certificate(const AuditedDrive& audited, const AuditScene& scene,
                          const Saved& saved) const;
  void add_lists(const std::vector<AuditedDrive>& audits, const AuditScene& scene,
                 map::OutputFiles& files) const;

  std::filesystem::path svg_, report_, mcap_, certificate_, junit_, geojson_, saved_drive_,
      saved_occupancy_, saved_obstacles_;
  bool force_ = false;
};

}  // namespace roadbed::tools::commands::audits
