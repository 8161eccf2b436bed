#include "tools/export/mat_export.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/file_size_limit.h"
#include "tests/unit/tools/export/example_tables.h"
#include "tools/export/matio_library.h"

namespace fogline {
namespace {

using exports::Matio;

class MatExportTest : public testing::Test {
 protected:
  const test::ScratchFolder folder_;
  const std::string file_ = folder_.File("run.mat");
};

TEST_F(MatExportTest, HasAMatrixWithOneRowForEachMessage) {
  exports::WriteMat(ExampleTables(3), file_);
  const Matio::File mat(Matio::Get().open(file_.c_str(), MAT_ACC_RDONLY));
  ASSERT_NE(mat, nullptr);
  const Matio::Variable truth(Matio::Get().read(mat.get(), "TRUTH"));
  ASSERT_NE(truth, nullptr);
  const matvar_t* list = Matio::Get().get_field(truth.get(), "follower_gap_m", 0);
  ASSERT_NE(list, nullptr);
  ASSERT_EQ(list->rank, 2);
  EXPECT_EQ(list->dims[0], 3U);
  EXPECT_EQ(list->dims[1], 2U);
  const auto* values = static_cast<const double*>(list->data);
  // MAT-files have the columns one after another.
  EXPECT_EQ(std::vector(values, values + 6), (std::vector<double>{10, 11, 12, 20, 21, 22}));
  const matvar_t* header = Matio::Get().get_field(truth.get(), "header", 0);
  ASSERT_NE(header, nullptr);
  const matvar_t* step = Matio::Get().get_field(const_cast<matvar_t*>(header), "step", 0);
  ASSERT_NE(step, nullptr);
  const auto* steps = static_cast<const std::int64_t*>(step->data);
  EXPECT_EQ(std::vector(steps, steps + 3), (std::vector<std::int64_t>{0, 1, 2}));
}

TEST_F(MatExportTest, FailsAndLeavesNoFileWhereverTheDiskIsFull) {
  const exports::RunTables tables = ExampleTables(700);
  exports::WriteMat(tables, file_);
  const std::uintmax_t whole = std::filesystem::file_size(file_);
  const std::string other = folder_.File("other.mat");
  for (std::uintmax_t bytes = 200; bytes < whole; bytes += 499) {
    const test::FileSizeLimit limit(bytes);
    EXPECT_THROW(exports::WriteMat(tables, other), std::runtime_error) << bytes << " bytes";
    EXPECT_FALSE(std::filesystem::exists(other)) << bytes << " bytes";
  }
}

}  // namespace
}  // namespace fogline
