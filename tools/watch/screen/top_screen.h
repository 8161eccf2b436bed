// The screen of `fogline top`: tables that scroll, a cursor, and the details of one row. The class
// has no terminal and no clock: its caller passes keys and sizes, and draws the lines.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/watch/screen/keys.h"
#include "tools/watch/screen/top_rows.h"

namespace fogline::watch {

class TopScreen {
 public:
  /// Replaces the shown data. The cursor stays on its row.
  void Show(TopView view);

  /// @return false if the key ends the program
  bool OnKey(Key key);

  /// The lines for a window of this size, at most `rows` lines. The first line is a summary. The
  /// last line names the keys.
  std::vector<Line> Lines(std::size_t columns, std::size_t rows);

 private:
  void Build();
  void Move(std::ptrdiff_t by);
  void ToNextTable();
  void Sort();
  void Reverse();
  Table table() const { return rows_.empty() ? Table::kNone : rows_[cursor_].table; }
  std::string Footer() const;
  std::vector<Line> Overview(std::size_t height);
  std::vector<Line> Details(std::size_t height);

  TopView view_;
  TableOrders orders_{};
  std::vector<TopRow> rows_;
  std::size_t cursor_ = 0;    // index in rows_
  std::string key_;           // key of the row at the cursor
  bool used_ = false;         // whether a key was pressed; else the cursor stays at the first row
  std::size_t first_ = 0;     // the first row that is visible
  std::string opened_;        // key of the opened row; "" if no row is open
  std::size_t scrolled_ = 0;  // lines of the details that are above the window
  std::size_t page_ = 1;      // rows of the last window; a page key moves by this number
};

}  // namespace fogline::watch
