// The meeting address of a test: the programs of the test that get no URL on their command line
// meet there.
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/command.h"

namespace fogline::test {

/// A multicast address that the variable LCM_DEFAULT_URL gives to all programs of a test.
class Meeting {
 public:
  const std::string& url() const { return url_; }

  /// The command line of a program that gets the address from LCM_DEFAULT_URL.
  std::vector<std::string> Command(const std::string& program,
                                   const std::vector<std::string>& arguments) const {
    std::vector<std::string> command{"env", "LCM_DEFAULT_URL=" + url_, Program(program)};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return command;
  }
  /// A run of the paper's scenario with a log of its own.
  std::vector<std::string> Run(const std::vector<std::string>& more) {
    ++logs_;
    std::vector<std::string> arguments{"run", "scenario/paper.json", "--log", Log()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Command("fogline", arguments);
  }
  /// The log of the last run.
  std::string Log() const { return folder_.File(std::to_string(logs_) + ".lcm"); }

 private:
  std::string url_ = runtime::FreshMulticastUrl();
  ScratchFolder folder_;
  int logs_ = 0;
};

/// The run id and the URL that a run prints on stderr: "run ID on URL".
struct Place {
  std::int64_t run_id = 0;
  std::string url;
};

inline Place PlaceOf(Background& run) {
  EXPECT_TRUE(run.WaitForErr("processes: ", kPatience)) << run.Err();
  std::istringstream words(run.Err());
  std::string word;
  Place place;
  words >> word >> place.run_id >> word >> place.url;
  return place;
}

/// What `fogline top --once --json` prints after 3 s: the document of one interval.
inline nlohmann::json TopOnce(const Meeting& meeting) {
  const Outcome top =
      RunCommand(meeting.Command("fogline", {"top", "--once", "--json", "--interval", "3"}));
  EXPECT_EQ(top.code, 0) << top.err;
  return nlohmann::json::parse(top.out, nullptr, false);
}

}  // namespace fogline::test
