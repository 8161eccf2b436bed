#include "tools/sweep/csv.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>

#include <fmt/core.h>

#include "scenario/loader.h"
#include "tools/sweep/description.h"
#include "tools/sweep/whole_file.h"

namespace fogline {
namespace {

std::string HeaderLine(const SweepPlan& plan) {
  std::string line;
  for (const Axis& axis : plan.axes()) line += axis.pointer + ",";
  line += "seed,si_pct";
  VisitMeasures(RunMeasures{}, [&line](std::string_view name, const auto&, std::string_view,
                                       std::string_view) { line += fmt::format(",{}", name); });
  return line + "\n";
}

/// What a row begins with: the values of its axes and its seed.
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
  number(row.si_pct);
  VisitMeasures(row.measures,
                [&]<class V>(std::string_view, const V& value, std::string_view, std::string_view) {
                  text += ',';
                  if constexpr (std::is_same_v<V, std::optional<double>>) {
                    number(value);
                  } else {
                    text += fmt::format("{}", value);
                  }
                });
  text += '\n';
}

/// Whether a file is that of this shard, by its description.
/// What the sweep in a file is; nothing if there is none in it.
std::optional<Description> SweepIn(const std::filesystem::path& file) {
  try {
    return ReadDescription(file);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

InputError CannotOpen(const std::filesystem::path& file, const char* why) {
  return InputError(fmt::format("{}: error: --out: cannot write: {}", file.string(), why));
}

}  // namespace

SweepFile::SweepFile(const std::filesystem::path& file, const SweepPlan& plan, const Shard& shard,
                     bool force)
    : path_(file), plan_(plan), next_unit_(plan.ShardBegin(shard)) {
  RequireFolderOf(path_, "--out");
  Open();
  const bool empty = lseek(file_.fd, 0, SEEK_END) == 0;
  const std::optional<Description> there = SweepIn(path_);
  if (!empty && !there) {
    throw InputError(
        fmt::format("{}: error: --out: the file is no sweep and stays as it is, --force or not",
                    path_.string()));
  }
  if (!empty && !force && there != Describe(plan, shard)) {
    throw InputError(
        fmt::format("{}: error: --out: the file is there and is not of this sweep; "
                    "--force replaces it",
                    path_.string()));
  }
  if (empty || force) {
    Start(shard);
  } else {
    Resume(shard);
  }
}

SweepFile::Handle::~Handle() {
  if (fd >= 0) close(fd);
}

// One writer at a time: two that append would mix their rows. A job that a cluster has started
// again, while its first incarnation was only cut off, is told so.
void SweepFile::Open() {
  file_.fd = open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_.fd < 0) throw CannotOpen(path_, std::strerror(errno));
  if (flock(file_.fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    throw CannotOpen(path_, "another sweep is writing it");
  }
}

void SweepFile::Cut(std::int64_t size) {
  if (lseek(file_.fd, 0, SEEK_END) != size && ftruncate(file_.fd, size) != 0) {
    throw CannotOpen(path_, std::strerror(errno));
  }
}

// The description comes while the file is empty, so no row is ever taken for one of another sweep.
void SweepFile::Start(const Shard& shard) {
  Cut(0);
  WriteDescription(path_, Describe(plan_, shard));
  Write(HeaderLine(plan_));
}

void SweepFile::Resume(const Shard& shard) {
  const std::int64_t all_rows =
      (plan_.ShardEnd(shard) - plan_.ShardBegin(shard)) * plan_.rows_per_unit();
  // Line by line, so that a file of any size takes no memory.
  std::ifstream in(path_, std::ios::binary);
  std::string line;
  std::int64_t whole = 0;  // end of the last whole unit, or of the header
  std::int64_t position = 0;
  std::int64_t row = -1;  // the header is none
  for (; std::getline(in, line) && !in.eof(); ++row) {
    std::int64_t index = row < 0 ? 0 : row % plan_.rows_per_unit();
    text_.clear();
    if (row < 0) {
      text_ = HeaderLine(plan_);
      text_.pop_back();
    } else if (row < all_rows) {
      AppendKey(plan_, next_unit_, index, text_);
    }
    if (text_.empty() || !line.starts_with(text_)) {
      throw InputError(
          fmt::format("{}:{}: error: --out: not the line that this sweep writes there; "
                      "--force begins anew",
                      path_.string(), row + 2));
    }
    position += static_cast<std::int64_t>(line.size()) + 1;
    if (row >= 0 && ++index == plan_.rows_per_unit()) ++next_unit_;
    if (row < 0 || index == plan_.rows_per_unit()) whole = position;
  }
  if (row < 0) return Start(shard);
  Cut(whole);
}

void SweepFile::Append(const std::vector<SweepRow>& rows) {
  text_.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    AppendRow(plan_, next_unit_, static_cast<std::int64_t>(i), rows[i], text_);
  }
  Write(text_);
  ++next_unit_;
}

void SweepFile::Write(const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = write(file_.fd, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      throw std::runtime_error(
          fmt::format("{}: cannot write: {}; call it again to go on where the file ends",
                      path_.string(), std::strerror(errno)));
    }
    done += static_cast<std::size_t>(written);
  }
}

}  // namespace fogline
