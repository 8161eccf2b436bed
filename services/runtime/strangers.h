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

/// Those that were heard most often. Whoever floods the network with names fills no memory, and
/// hides nobody who goes on speaking: a name that was heard once makes room before one that was
/// heard again.
class Strangers {
 public:
  /// So many are told of.
  static constexpr std::size_t kMax = 32;
  /// So many are watched. A role says its STATUS ten times a second, so it is heard again before it
  /// is forgotten unless others invent more than 10,000 names a second.
  static constexpr std::size_t kMaxWatched = 1024;

  /// Takes note of a STATUS of another run. Names that are no role's are nobody's; host names are
  /// cut to what may stand in a terminal.
  void Hear(const status_t& status);

  /// At most kMax, in the order in which they were heard first.
  std::vector<Stranger> known() const;
  /// One line each, "ignored: ...", and one more if there were more than kMax. Empty without any.
  std::string Text() const;

 private:
  struct Watched {
    Stranger stranger;
    std::int64_t heard;
  };
  std::vector<Watched> watched_;  // in the order in which they were heard first
  bool forgotten_ = false;
};

}  // namespace fogline
