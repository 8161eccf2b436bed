// A study over a few seeds, for tests.
#pragma once

#include <cstdint>

#include "tests/support/command.h"
#include "tools/study/study.h"

namespace fogline::test {

inline study::StudyContext FewSeeds(std::int64_t first, std::int64_t last) {
  return {.scenarios = SourceDirectory() / "scenario",
          .seeds = {.first = first, .last = last},
          .jobs = 2,
          .progress = [](std::int64_t, std::int64_t) { return true; }};
}

}  // namespace fogline::test
