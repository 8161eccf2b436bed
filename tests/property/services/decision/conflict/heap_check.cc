// Checks that no conflict measure allocates memory in a step, with any rule for missing values. The
// program replaces operator new, so it is separate from other tests. It prints the measures that
// allocate memory, and exits with 1 if there are any.
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "services/decision/conflict/conflict_measures.h"
#include "tests/unit/services/decision/conflict/evidence.h"

namespace {
long allocations = 0;
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* block = std::malloc(size)) return block;
  throw std::bad_alloc();
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }

namespace fogline {
namespace {

constexpr int kSteps = 1000;

// Prints the measures of these rows that allocate memory in a step. @return whether any measure
// allocates memory
template <class Row>
bool Allocates(std::span<const Row> rows, const conflict::ConflictParameters& parameters) {
  const Random random(1, Stream::kRadar);
  bool any = false;
  for (const Row& row : rows) {
    const auto measure = row.make(parameters);
    const long before = allocations;
    for (int step = 0; step < kSteps; ++step) measure->Step(Anything(random, step));
    measure->Reset();
    const long made = allocations - before;
    if (made > 0) std::printf("%s: %ld allocations\n", row.name.data(), made);
    any = any || made > 0;
  }
  return any;
}

bool Check() {
  bool any = false;
  for (const auto rule : {MissingLidar::kHold, MissingLidar::kSkip, MissingLidar::kConflict}) {
    conflict::ConflictParameters parameters;
    parameters.missing = rule;
    any = Allocates(conflict::ConflictMeasures(), parameters) || any;
    any = Allocates(conflict::BlameMeasures(), parameters) || any;
  }
  // Each measure itself is allocated on the heap, so a count of 0 means that the counter is broken.
  return !any && allocations > 0;
}

}  // namespace
}  // namespace fogline

int main() { return fogline::Check() ? 0 : 1; }
