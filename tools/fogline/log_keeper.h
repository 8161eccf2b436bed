// The log of a run as its runner sees it: whether what is on the disk in the end is what the run's
// recorder has written, and the seal that says so later.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <vector>

#include "services/recorder/run_log.h"
#include "services/runtime/other_build.h"

namespace fogline {

class LogKeeper {
 public:
  /// Notes which file it is that the run begins with, if there is one.
  explicit LogKeeper(std::filesystem::path log);

  /// @param written what each of the run's recorders has told last
  /// @throws std::runtime_error if another file has taken its place, or it holds other bytes
  void Check(const std::vector<WrittenLog>& written) const;
  /// Whether nothing stands in the file behind what was told.
  bool HasAllTold(const std::vector<WrittenLog>& written) const;

  /// Checks the file again and seals it.
  /// @param run all of the file
  /// @param builds what each role has said of its build
  /// @param key signs the seal; nullptr: no signature
  /// @throws std::runtime_error as Check(), or if it cannot be written
  void Seal(const RunLog& run, const std::vector<WrittenLog>& written, const RoleBuilds& builds,
            const SealKey* key) const;
  /// The same for a run that was cut off, whose log is not read otherwise. What cannot be sealed is
  /// left as it is.
  void SealCutOff(const std::vector<WrittenLog>& written, const RoleBuilds& builds,
                  const SealKey* key) const noexcept;

 private:
  struct Identity {
    dev_t device;
    ino_t inode;
    bool operator==(const Identity&) const = default;
  };
  std::optional<Identity> Find() const;
  /// The bytes on the disk. @throws std::runtime_error as Check()
  void Check(const EventLogReader& file, const std::vector<WrittenLog>& written) const;

  std::filesystem::path log_;
  std::optional<Identity> begun_with_;
};

}  // namespace fogline
