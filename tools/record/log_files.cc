#include "tools/record/log_files.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"

namespace fogline::record {

LogFiles::LogFiles(std::filesystem::path file, const Rotation& rotation, TimePoint now)
    : file_(std::move(file)), rotation_(rotation) {
  Begin(now);
  if (rotation_.Any()) RemoveEarlierRecording();
}

void LogFiles::RemoveEarlierRecording() {
  for (const std::filesystem::path& earlier : InTheWay(file_)) {
    std::error_code error;
    if (earlier == files_.front() || !std::filesystem::is_regular_file(earlier, error)) continue;
    if (!std::filesystem::remove(earlier, error) && error) {
      throw InputError(
          fmt::format("{}: error: LOG: this file of an earlier recording cannot be removed: {}",
                      PathText(earlier), error.message()));
    }
    ++removed_;
  }
}

std::filesystem::path LogFiles::NameOf(const std::filesystem::path& file, std::size_t number) {
  return file.parent_path() /
         fmt::format("{}-{:03}{}", file.stem().string(), number, file.extension().string());
}

std::vector<std::filesystem::path> LogFiles::InTheWay(const std::filesystem::path& file) {
  const std::string begin = file.stem().string() + '-';
  std::vector<std::filesystem::path> found;
  std::error_code ignored;
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().stem().string();
    const std::string_view rest =
        std::string_view(name).substr(std::min(begin.size(), name.size()));
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    if (error != std::errc() || end != rest.data() + rest.size()) continue;
    const std::filesystem::path one = NameOf(file, number);
    if (one.filename() == entry.path().filename()) found.push_back(one);
  }
  std::ranges::sort(found);
  return found;
}

void LogFiles::Begin(TimePoint now) {
  if (log_) earlier_bytes_ += log_->size();
  log_.reset();
  ends_.clear();
  flushed_ = 0;
  begun_ = now;
  files_.push_back(rotation_.Any() ? NameOf(file_, files_.size()) : file_);
  log_.emplace(files_.back());
}

void LogFiles::Write(const log::Event& event, TimePoint now) {
  const std::int64_t size = static_cast<std::int64_t>(log::SizeInFile(event));
  const bool is_full =
      rotation_.most_bytes > 0 && log_->size() > 0 && log_->size() + size > rotation_.most_bytes;
  const bool is_old = rotation_.longest > Duration::zero() && now - begun_ >= rotation_.longest;
  try {
    if (is_full || is_old) {
      log_->Flush();
      Begin(now);
    }
    ends_.push_back(log_->size() + size);
    log_->Write(event.channel, event.utime, event.data);
  } catch (const InputError& error) {  // the next file cannot be opened
    throw std::runtime_error(error.what());
  } catch (const std::runtime_error&) {
    CutTornEvent();
    throw;
  }
}

void LogFiles::Flush() {
  try {
    log_->Flush();
  } catch (const std::runtime_error&) {
    CutTornEvent();
    throw;
  }
  flushed_ = log_->size();
  ends_.clear();
}

void LogFiles::CutTornEvent() {
  earlier_bytes_ += flushed_;
  log_.reset();  // writes the remaining events, if possible
  std::error_code ignored;
  const auto written =
      static_cast<std::int64_t>(std::filesystem::file_size(files_.back(), ignored));
  std::int64_t whole = flushed_;
  for (const std::int64_t end : ends_) whole = end <= written ? std::max(whole, end) : whole;
  if (whole < written) {
    std::filesystem::resize_file(files_.back(), static_cast<std::uintmax_t>(whole), ignored);
  }
  earlier_bytes_ += whole - flushed_;
}

}  // namespace fogline::record
