// The requirements of a test on its machine.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace fogline::test {

/// Ends a test, or its SetUp(), on a machine that lacks a requirement (root, namespaces, nftables).
/// The test is skipped. If FOGLINE_TEST_NO_SKIP is set, all tests must run, so the test fails.
/// Usage: `if (geteuid() != 0) return MachineLacks("root");`
inline void MachineLacks(const std::string& what) {
  if (std::getenv("FOGLINE_TEST_NO_SKIP") != nullptr) FAIL() << "this machine lacks " << what;
  GTEST_SKIP() << "this machine lacks " << what;
}

}  // namespace fogline::test
