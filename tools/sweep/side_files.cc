#include "tools/sweep/side_files.h"

#include "common/atomic_file.h"
#include "tools/sweep/description.h"
#include "tools/sweep/row_sums.h"

namespace fogline::sweep {

void RefuseForeignSideFiles(const std::filesystem::path& csv) {
  // The argument `force` is true, because a sweep replaces the side files of another sweep even
  // without --force.
  RefuseToReplace(DescriptionFile(csv), "--out", true, "sweep description",
                  [&csv](const std::filesystem::path&) { return IsSweep(csv); });
  RefuseToReplace(SumsFile(csv), "--out", true, "file of checksums", IsSums);
}

}  // namespace fogline::sweep
