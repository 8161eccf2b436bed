// Tables of a short log, for tests of exports.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/export/run_tables.h"

namespace fogline {

/// The table of TRUTH with some of its fields: in message i, gap is 30 + i, and the list
/// follower_gap_m is 10 + i, 20 + i.
inline exports::RunTables ExampleTables(std::size_t messages) {
  std::vector<std::int64_t> run_ids(messages, 7);
  std::vector<std::int64_t> steps;
  std::vector<std::int64_t> utimes;
  std::vector<double> gaps;
  std::vector<double> follower_gaps;
  for (std::size_t i = 0; i < messages; ++i) {
    const auto number = static_cast<std::int64_t>(i);
    steps.push_back(number);
    utimes.push_back(100'000 * number);
    gaps.push_back(30.0 + static_cast<double>(i));
    follower_gaps.push_back(10.0 + static_cast<double>(i));
    follower_gaps.push_back(20.0 + static_cast<double>(i));
  }
  exports::RunTables tables;
  tables.channels.push_back(
      {.name = "TRUTH",
       .fields = {{.name = "header.run_id", .values = run_ids},
                  {.name = "header.step", .values = steps},
                  {.name = "header.utime", .values = utimes},
                  {.name = "host_gap_m", .values = gaps},
                  {.name = "follower_gap_m", .is_list = true, .width = 2, .values = follower_gaps}},
       .messages = messages,
       .gaps = {}});
  tables.scenario = "{}";
  return tables;
}

}  // namespace fogline
