// The data of `fogline top` as rows of tables for 80 columns.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "services/runtime/discovery/announcements.h"
#include "services/runtime/discovery/waiting_roles.h"
#include "tools/watch/senders/senders.h"
#include "tools/watch/traffic_statistics.h"
#include "tools/watch/traffic_text.h"

namespace fogline::watch {

/// The data of `fogline top` at one time.
struct TopView {
  std::string url;
  TrafficView traffic;
  SendersView senders;
  std::vector<runtime::Announcement> announced;
  bool followed = false;  // whether the first announced run is shown
  std::vector<runtime::WaitingRole> waiting;
};

enum class Table : std::size_t { kNone, kRoles, kChannels, kWaiting, kSenders };
inline constexpr std::size_t kTables = 5;

/// The order of a table.
struct TableOrder {
  std::size_t column = 0;  // index in SortColumns(); 0: the natural order
  bool reversed = false;
};
using TableOrders = std::array<TableOrder, kTables>;

/// The columns by which a table can be sorted. The first one stands for the natural order.
std::vector<std::string_view> SortColumns(Table table);

/// A row of a table. If `key` is not empty, the user can open the row to see its details.
struct TopRow {
  Line line;
  Table table = Table::kNone;
  std::string key;  // names the role, channel or sender in later views, too; "" for headings
};

/// The rows of all tables: roles and channels of each run, waiting roles, other channels, senders.
std::vector<TopRow> TopRows(const TopView& view, const TableOrders& orders);

/// All details of the role, channel or sender of a row; the first line is the title. Empty if the
/// view has no such row.
std::vector<Line> DetailsOf(const std::string& key, const TopView& view);

}  // namespace fogline::watch
