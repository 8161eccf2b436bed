// A window with the values of the last steps, for measures of conflict.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace fogline::conflict {

/// The values of the last W steps. A step without a value adds an empty entry. Every entry, also an
/// empty one, leaves the window after W steps. A measure computes its sum again from all entries in
/// every step. So its result depends only on the contents of the window, and not on the rounding of
/// earlier steps.
class Window {
 public:
  /// @param steps W, at least 1
  explicit Window(int steps) : values_(static_cast<std::size_t>(steps)) {}

  void Push(std::optional<double> value) {
    values_[oldest_] = value;
    oldest_ = (oldest_ + 1) % values_.size();
  }

  void Clear() {
    for (std::optional<double>& value : values_) value.reset();
    oldest_ = 0;
  }

  /// Calls visit(value) for each value, oldest first; skips empty entries.
  template <class Visitor>
  void ForEach(Visitor&& visit) const {
    const auto visit_places = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (values_[i]) visit(*values_[i]);
      }
    };
    visit_places(oldest_, values_.size());
    visit_places(0, oldest_);
  }

  /// Calls visit(value) for each value, newest first; skips empty entries.
  template <class Visitor>
  void ForEachBackwards(Visitor&& visit) const {
    for (std::size_t i = values_.size(); i > 0; --i) {
      const std::optional<double>& value = values_[(oldest_ + i - 1) % values_.size()];
      if (value) visit(*value);
    }
  }

 private:
  std::vector<std::optional<double>> values_;  // a ring buffer
  std::size_t oldest_ = 0;
};

}  // namespace fogline::conflict
