// The requirements of a test for the machine on which it runs.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace fogline::test {

/// Ends a test, or its SetUp(), on a machine that lacks a requirement (root, namespaces, nftables).
/// The test is skipped, or fails if FOGLINE_TEST_NO_SKIP is set.
/// Usage: `if (geteuid() != 0) return MachineLacks("root");`
inline void MachineLacks(const std::string& what) {
  if (std::getenv("FOGLINE_TEST_NO_SKIP") != nullptr) FAIL() << "this machine lacks " << what;
  GTEST_SKIP() << "this machine lacks " << what;
}

}  // namespace fogline::test
