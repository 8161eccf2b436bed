// What a test needs of the machine that it runs on.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace fogline::test {

/// Ends a test, or its SetUp(), on a machine without what it needs (root, namespaces, nftables):
/// skipped, or failed if FOGLINE_TEST_NO_SKIP is set, as where all tests have to run.
/// Usage: `if (geteuid() != 0) return MachineLacks("root");`
inline void MachineLacks(const std::string& what) {
  if (std::getenv("FOGLINE_TEST_NO_SKIP") != nullptr) FAIL() << "this machine lacks " << what;
  GTEST_SKIP() << "this machine lacks " << what;
}

}  // namespace fogline::test
