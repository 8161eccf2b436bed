#include "tools/watch/screen/top_screen.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/core.h>

namespace fogline::watch {
namespace {

/// Cuts or fills a text to the width of the window.
std::string Wide(std::string text, std::size_t columns) {
  if (text.size() > columns && columns > 3) {
    text.resize(columns - 3);
    return text + "...";
  }
  text.resize(columns, ' ');
  return text;
}

}  // namespace

void TopScreen::Show(TopView view) {
  view_ = std::move(view);
  Build();
}

void TopScreen::Build() {
  rows_ = TopRows(view_, orders_);
  if (!used_) {
    // Until a key is pressed, the cursor stays at the first row, also if new rows come above the
    // old first row.
    cursor_ = 0;
    return Move(0);
  }
  const auto same = std::ranges::find_if(
      rows_, [this](const TopRow& row) { return !key_.empty() && row.key == key_; });
  if (same != rows_.end()) {
    cursor_ = static_cast<std::size_t>(same - rows_.begin());
  } else {
    cursor_ = std::min(cursor_, rows_.size() - std::min<std::size_t>(1, rows_.size()));
    Move(0);
  }
}

/// Moves the cursor by this number of rows that can be opened.
void TopScreen::Move(std::ptrdiff_t by) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!rows_[i].key.empty()) places.push_back(i);
  }
  if (places.empty()) return;
  auto at = std::ranges::lower_bound(places, cursor_) - places.begin();
  at = std::clamp<std::ptrdiff_t>(at + by, 0, std::ssize(places) - 1);
  cursor_ = places[static_cast<std::size_t>(at)];
  key_ = rows_[cursor_].key;
}

void TopScreen::ToNextTable() {
  const auto begins = [this](std::size_t i) {
    return !rows_[i].key.empty() && (i == 0 || rows_[i - 1].key.empty());
  };
  for (std::size_t step = 1; step <= rows_.size(); ++step) {
    const std::size_t place = (cursor_ + step) % rows_.size();
    if (!begins(place)) continue;
    cursor_ = place;
    key_ = rows_[place].key;
    return;
  }
}

void TopScreen::Sort() {
  TableOrder& order = orders_[static_cast<std::size_t>(table())];
  order.column = (order.column + 1) % SortColumns(table()).size();
  order.reversed = false;
  Build();
}

void TopScreen::Reverse() {
  TableOrder& order = orders_[static_cast<std::size_t>(table())];
  order.reversed = !order.reversed;
  Build();
}

bool TopScreen::OnKey(Key key) {
  used_ = true;
  const auto page = static_cast<std::ptrdiff_t>(page_);
  const auto scroll = [this](std::ptrdiff_t by) {
    if (opened_.empty()) return Move(by);
    const auto to = static_cast<std::ptrdiff_t>(scrolled_) + by;
    scrolled_ = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, to));
  };
  constexpr std::ptrdiff_t kFar = 1'000'000;
  switch (key) {
    case Key::kUp:
      scroll(-1);
      break;
    case Key::kDown:
      scroll(1);
      break;
    case Key::kPageUp:
      scroll(-page);
      break;
    case Key::kPageDown:
      scroll(page);
      break;
    case Key::kHome:
      scroll(-kFar);
      break;
    case Key::kEnd:
      scroll(kFar);
      break;
    case Key::kNextTable:
      if (opened_.empty()) ToNextTable();
      break;
    case Key::kOpen:
      if (opened_.empty()) opened_ = key_;
      scrolled_ = 0;
      break;
    case Key::kClose:
      opened_.clear();
      break;
    case Key::kSort:
      if (opened_.empty()) Sort();
      break;
    case Key::kReverse:
      if (opened_.empty()) Reverse();
      break;
    case Key::kQuit:
      return false;
  }
  return true;
}

std::string TopScreen::Footer() const {
  if (!opened_.empty()) return "q quit  arrows scroll  Esc close";
  const TableOrder& order = orders_[static_cast<std::size_t>(table())];
  return fmt::format("q quit  arrows move  Tab table  Enter open  s sort: {}  r {}",
                     SortColumns(table())[order.column], order.reversed ? "reversed" : "reverse");
}

std::vector<Line> TopScreen::Overview(std::size_t height) {
  if (rows_.empty()) return {};
  if (cursor_ < first_) first_ = cursor_;
  // If the cursor is at the first row that can be opened, the headings above this row are also
  // shown.
  const bool top =
      std::ranges::all_of(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(cursor_),
                          [](const TopRow& row) { return row.key.empty(); });
  if (top) first_ = 0;
  if (cursor_ >= first_ + height) first_ = cursor_ + 1 - height;
  // If the cursor is at the last row that can be opened, the remarks below this row are also shown.
  const std::size_t last = rows_.size() > height ? rows_.size() - height : 0;
  const bool bottom =
      std::ranges::all_of(rows_.begin() + static_cast<std::ptrdiff_t>(cursor_) + 1, rows_.end(),
                          [](const TopRow& row) { return row.key.empty(); });
  first_ = bottom && !top ? last : std::min(first_, last);
  std::vector<Line> lines;
  for (std::size_t i = first_; i < std::min(rows_.size(), first_ + height); ++i) {
    lines.push_back(rows_[i].line);
    if (i == cursor_ && !rows_[i].key.empty()) lines.back().style = Line::Style::kSelected;
  }
  return lines;
}

std::vector<Line> TopScreen::Details(std::size_t height) {
  std::vector<Line> all = DetailsOf(opened_, view_);
  if (all.empty()) all = {{"it is gone", Line::Style::kHeading}};
  // The title is always visible.
  std::vector<Line> lines{all.front()};
  all.erase(all.begin());
  const std::size_t room = height - std::min<std::size_t>(height, 1);
  scrolled_ = std::min(scrolled_, all.size() > room ? all.size() - room : 0);
  for (std::size_t i = scrolled_; i < std::min(all.size(), scrolled_ + room); ++i) {
    lines.push_back(all[i]);
  }
  return lines;
}

std::vector<Line> TopScreen::Lines(std::size_t columns, std::size_t rows) {
  constexpr std::size_t kFrame = 2;  // summary and footer
  const std::size_t height = rows > kFrame ? rows - kFrame : 1;
  page_ = height;
  std::vector<Line> lines{SummaryLine(view_.traffic, view_.url)};
  std::vector<Line> body = opened_.empty() ? Overview(height) : Details(height);
  std::ranges::move(body, std::back_inserter(lines));
  lines.resize(std::max(lines.size(), height + 1));
  lines.push_back({Footer(), Line::Style::kSelected});
  // The last column stays empty, because terminals differ in how they treat text at their edge.
  const std::size_t width = columns > 1 ? columns - 1 : 1;
  for (Line& line : lines) line.text = Wide(std::move(line.text), width);
  lines.resize(std::min(lines.size(), rows));
  return lines;
}

}  // namespace fogline::watch
