// Helpers for tests that compare the digests of a run on several transports: in one process, in
// memory and over the network.
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/command.h"

namespace fogline::test {

/// Executes `fogline run`, which must succeed, with these fields set. @return the result as JSON
/// @param more further arguments
inline nlohmann::json RunOn(const std::string& transport, const std::string& scenario,
                            const std::string& log, const std::vector<std::string>& fields,
                            const std::vector<std::string>& more = {}) {
  std::vector<std::string> command{Program("fogline"), "run",     scenario, "--json", "--quiet",
                                   "--transport",      transport, "--log",  log,      "--force"};
  for (const std::string& field : fields) command.insert(command.end(), {"--set", field});
  command.insert(command.end(), more.begin(), more.end());
  const Outcome outcome = RunCommand(command);
  EXPECT_EQ(outcome.code, 0) << transport << ": " << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false);
}

/// Expects the same digest, measures and steps in one process, in memory and over the network.
/// @param run runs the scenario on a transport
/// @return the result of the run in one process
inline nlohmann::json ExpectTheSameOnAnyTransport(
    const std::function<nlohmann::json(const std::string& transport)>& run, int steps) {
  const nlohmann::json direct = run("direct");
  EXPECT_EQ(direct["steps"], steps);
  EXPECT_EQ(direct["digest"].get<std::string>().size(), 64U);
  for (const char* transport : {"memq", "udpm"}) {
    const nlohmann::json other = run(transport);
    EXPECT_EQ(other["steps"], steps) << transport;
    EXPECT_EQ(other["digest"], direct["digest"]) << transport;
    EXPECT_EQ(other["metrics"], direct["metrics"]) << transport;
  }
  return direct;
}

}  // namespace fogline::test
