// Processes that speak on a run's network without being of it: roles of another run there, or left
// over from an earlier one. What they send is refused; this is to know who they are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fogline/status_t.hpp"

namespace fogline {

struct Stranger {
  std::string role;
  std::int64_t pid;
  std::string host;
  std::int64_t run_id;
};

/// "fusion (pid 4711 on lab2) of run 123"
std::string Describe(const Stranger& stranger);

/// The first kMax that were heard; whoever floods the network with names fills no memory.
class Strangers {
 public:
  static constexpr std::size_t kMax = 32;

  /// Takes note of a STATUS of another run. Names that are no role's are nobody's; host names are
  /// cut to what may stand in a terminal.
  void Hear(const status_t& status);

  const std::vector<Stranger>& known() const { return known_; }
  /// One line each, "ignored: ...", and one more if there were more than kMax. Empty without any.
  std::string Text() const;

 private:
  std::vector<Stranger> known_;
  bool more_ = false;
};

}  // namespace fogline
