#include "services/runtime/seat/seat_instance.h"

#include <sodium.h>

namespace fogline::runtime {

std::int64_t DrawSeatInstance() {
  std::int64_t instance = 0;
  while (instance == 0) randombytes_buf(&instance, sizeof(instance));
  return instance;
}

}  // namespace fogline::runtime
