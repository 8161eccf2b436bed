#include "tools/processes/web_child.h"

#include "common/clock.h"
#include "tools/processes/child.h"

namespace fogline::processes {
namespace {

// fogline-web ends within this time after SIGTERM. After that it is killed.
constexpr Duration kFarewellLimit = milliseconds(2000);

}  // namespace

std::string PortOf(const std::string& address) {
  if (address.empty()) return "0";
  const std::size_t begin = address.rfind(':') + 1;
  return address.substr(begin, address.find('/', begin) - begin);
}

void EndWeb(pid_t& pid) {
  if (pid >= 0) EndChild(pid, kFarewellLimit);
  pid = -1;
}

}  // namespace fogline::processes
