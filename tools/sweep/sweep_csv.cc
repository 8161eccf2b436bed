#include "tools/sweep/sweep_csv.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string_view>

#include <fmt/core.h>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/file.h"
#include "common/interrupt.h"
#include "common/text.h"
#include "tools/sweep/description.h"
#include "tools/sweep/row_sums.h"
#include "tools/sweep/side_files.h"

namespace fogline::sweep {
namespace {

constexpr int kFlags = O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC;
// Checksums are written in pieces of this size, to save system calls.
constexpr std::size_t kSumBytesAtOnce = 1 << 16;

std::string HeaderLine(const SweepPlan& plan) {
  std::string line;
  for (const Axis& axis : plan.axes()) line += axis.pointer + ",";
  line += "seed,si_pct";
  metrics::VisitMetrics(metrics::RunMetrics{},
                        [&line](std::string_view name, const auto&, std::string_view,
                                std::string_view) { line += fmt::format(",{}", name); });
  return line + ",si_until_recovery_pct\n";
}

/// Appends the beginning of a row: the values of its axes and its seed.
void AppendKey(const SweepPlan& plan, std::int64_t unit, std::int64_t index, std::string& text) {
  for (const std::string_view value : plan.ValuesOf(unit, index)) {
    text += value;
    text += ',';
  }
  text += fmt::format("{},", plan.SeedOf(unit));
}

void AppendRow(const SweepPlan& plan, std::int64_t unit, std::int64_t index, const SweepRow& row,
               std::string& text) {
  const auto number = [&text](const std::optional<double>& value) {
    if (value) text += fmt::format("{}", *value);
  };
  AppendKey(plan, unit, index, text);
  number(row.paired.si_pct);
  metrics::VisitMetrics(row.measures, [&]<class V>(std::string_view, const V& value,
                                                   std::string_view, std::string_view) {
    text += ',';
    if constexpr (std::is_same_v<V, std::optional<double>>) {
      number(value);
    } else {
      text += fmt::format("{}", value);
    }
  });
  text += ',';
  number(row.paired.si_until_recovery_pct);
  text += '\n';
}

[[noreturn]] void Refuse(const std::filesystem::path& file, std::string_view why) {
  throw InputError(fmt::format("{}: error: --out: {}", PathText(file), why));
}

[[noreturn]] void ThrowCannotWrite(const std::filesystem::path& file, int error) {
  ThrowIfExhausted(error, PathText(file));
  Refuse(file, fmt::format("cannot write: {}", std::strerror(error)));
}

}  // namespace

SweepFile::SweepFile(const std::filesystem::path& file, const SweepPlan& plan, const Shard& shard,
                     bool force)
    : plan_(plan), next_unit_(plan.ShardBegin(shard)), file_(file), sums_(SumsFile(file)) {
  if (IsReplaceable(file_.path)) {
    RequireFolderOf(file_.path, "--out");
    RefuseForeignSideFiles(file_.path);
    Open();
    IsToBeReplaced(shard, force) ? Start(shard) : Resume(shard);
  } else {
    file_.fd = OpenStream(file_.path, "--out");
    Write(HeaderLine(plan_), file_);
  }
}

bool SweepFile::IsToBeReplaced(const Shard& shard, bool force) const {
  if (lseek(file_.fd, 0, SEEK_END) == 0) return true;
  if (!IsSweep(file_.path))
    Refuse(file_.path, "the file is no sweep and is not replaced, even with --force");
  if (force) return true;
  if (ReadDescription(file_.path) == Describe(plan_, shard)) return false;
  Refuse(file_.path, "the file exists and is not of this sweep; --force replaces it");
}

SweepFile::Handle::~Handle() {
  if (fd >= 0) close(fd);
}

// The lock admits only one writer at a time, because two writers would mix their rows. A second
// writer is possible if a cluster loses the connection to a job, and starts the job a second time
// while the job's first process still writes.
void SweepFile::Open() {
  file_.fd = open(file_.path.c_str(), kFlags, 0666);
  if (file_.fd < 0) ThrowCannotWrite(file_.path, errno);
  if (flock(file_.fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    Refuse(file_.path, "cannot write: another sweep is writing it");
  }
}

void SweepFile::OpenSums() {
  sums_.fd = open(sums_.path.c_str(), kFlags | O_NOFOLLOW, 0666);
  if (sums_.fd < 0) ThrowCannotWrite(sums_.path, errno);
}

void SweepFile::Cut(std::int64_t size, const Handle& file) {
  if (lseek(file.fd, 0, SEEK_END) != size && ftruncate(file.fd, size) != 0) {
    ThrowCannotWrite(file.path, errno);
  }
}

// The description is written while the file is empty. So no row can be mistaken for a row of
// another sweep.
void SweepFile::Start(const Shard& shard) {
  if (sums_.fd < 0) OpenSums();
  Cut(0, file_);
  Cut(0, sums_);
  WriteDescription(file_.path, Describe(plan_, shard));
  Write(HeaderLine(plan_), file_);
}

void SweepFile::Resume(const Shard& shard) {
  const std::int64_t all_rows =
      (plan_.ShardEnd(shard) - plan_.ShardBegin(shard)) * plan_.rows_per_unit();
  // The file is read line by line, so that the memory does not depend on the size of the file.
  std::ifstream in(file_.path, std::ios::binary);
  RowChecker checker(file_.path);
  std::string line;
  std::int64_t whole = 0;  // end of the last whole unit, or of the header
  std::int64_t position = 0;
  std::int64_t row = -1;  // -1 is the header
  for (; std::getline(in, line) && !in.eof(); ++row) {
    std::int64_t index = row < 0 ? 0 : row % plan_.rows_per_unit();
    text_.clear();
    if (row < 0) {
      text_ = HeaderLine(plan_);
      text_.pop_back();
    } else if (row < all_rows) {
      AppendKey(plan_, next_unit_, index, text_);
    }
    const bool has_key = !text_.empty() && line.starts_with(text_);
    const auto verdict =
        row < 0 || !checker.has_sums() ? RowChecker::Verdict::kSame : checker.Check(line);
    if (verdict == RowChecker::Verdict::kNoSum)
      break;  // the sweep computes this row and all later rows again
    if (!has_key || verdict == RowChecker::Verdict::kOther) {
      throw InputError(
          fmt::format("{}:{}: error: --out: the line differs from the one that this sweep {} "
                      "there; --force starts over",
                      PathText(file_.path), row + 2, has_key ? "has written" : "writes"));
    }
    position += static_cast<std::int64_t>(line.size()) + 1;
    if (row >= 0 && ++index == plan_.rows_per_unit()) ++next_unit_;
    if (row < 0 || index == plan_.rows_per_unit()) whole = position;
  }
  OpenSums();
  if (position == 0) return Start(shard);
  Cut(whole, file_);
  const std::int64_t rows = (next_unit_ - plan_.ShardBegin(shard)) * plan_.rows_per_unit();
  if (checker.has_sums()) {
    Cut(rows * kSumLineBytes, sums_);
  } else {
    SumRows();
  }
}

void SweepFile::SumRows() {
  std::ifstream in(file_.path, std::ios::binary);
  std::string line;
  std::getline(in, line);  // the header
  text_.clear();
  while (std::getline(in, line)) {
    text_ += SumLine(line);
    if (text_.size() < kSumBytesAtOnce) continue;
    Write(text_, sums_);
    text_.clear();
  }
  Write(text_, sums_);
}

void SweepFile::Append(const std::vector<SweepRow>& rows) {
  text_.clear();
  std::string sums;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t begin = text_.size();
    AppendRow(plan_, next_unit_, static_cast<std::int64_t>(i), rows[i], text_);
    sums += SumLine(std::string_view(text_).substr(begin, text_.size() - begin - 1));
  }
  Write(text_, file_);
  ++next_unit_;
  if (sums_.fd < 0) return;  // a pipe or device has no checksums, because no sweep reads its rows
  Write(sums, sums_);
  RequireInPlace();
}

void SweepFile::RequireInPlace() const {
  struct stat named {};
  struct stat written {};
  if (stat(file_.path.c_str(), &named) == 0 && fstat(file_.fd, &written) == 0 &&
      named.st_dev == written.st_dev && named.st_ino == written.st_ino) {
    return;
  }
  throw std::runtime_error(
      fmt::format("{}: the file was removed or replaced while the sweep wrote it, and its rows are "
                  "lost; call it again to start over",
                  PathText(file_.path)));
}

void SweepFile::Write(std::string_view text, const Handle& file) const {
  // A write to a file does not block. A write to a pipe may block forever, so an interrupt ends a
  // write to a pipe.
  const int error = WriteAll(file.fd, text, sums_.fd < 0 ? WasInterrupted : nullptr);
  if (error == 0) return;
  if (error == EINTR) throw Interrupted(fmt::format("interrupted in {}", PathText(file.path)));
  throw std::runtime_error(
      fmt::format("{}: cannot write: {}; call it again to continue at the end of the file",
                  PathText(file.path), std::strerror(error)));
}

}  // namespace fogline::sweep
