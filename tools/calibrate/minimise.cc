#include "tools/calibrate/minimise.h"

#include <exception>

#include <nlopt.hpp>

namespace fogline::calibrate {
namespace {

// First and smallest step of a search around its start, as shares of each range. The search ends
// when its steps are as small as the rounding of the values.
constexpr double kFirstStep = 0.05;
constexpr double kSmallestStep = 1e-6;

// Chooses the algorithm. DIRECT-L (Gablonsky & Kelley 2001) divides the whole range and uses no
// random numbers. Subplex (Rowan 1990) searches around a start, and tolerates jumps of the
// objective. A jump occurs where the human drives one time step more or less.
nlopt::algorithm AlgorithmFor(Reach reach) {
  return reach == Reach::kWholeRange ? nlopt::GN_DIRECT_L : nlopt::LN_SBPLX;
}

/// Calls the function, and stores an exception of the function, because NLopt passes on only its
/// own exceptions.
struct Guarded {
  const FunctionOfShares& function;
  std::exception_ptr failure;

  double operator()(const std::vector<double>& shares) {
    std::optional<double> value;
    try {
      value = function(shares);
    } catch (...) {
      failure = std::current_exception();
    }
    if (!value) throw nlopt::forced_stop();
    return *value;
  }
};

}  // namespace

void Minimise(Reach reach, const FunctionOfShares& function, std::vector<double> start,
              double enough, int most) {
  Guarded guarded{.function = function, .failure = nullptr};
  nlopt::opt optimizer(AlgorithmFor(reach), static_cast<unsigned>(start.size()));
  optimizer.set_lower_bounds(0);
  optimizer.set_upper_bounds(1);
  optimizer.set_min_objective([](const std::vector<double>& shares, std::vector<double>&,
                                 void* data) { return (*static_cast<Guarded*>(data))(shares); },
                              &guarded);
  optimizer.set_stopval(enough);
  optimizer.set_maxeval(most);
  optimizer.set_xtol_abs(kSmallestStep);
  optimizer.set_initial_step(kFirstStep);
  double reached = 0;
  try {
    optimizer.optimize(start, reached);
  } catch (const nlopt::forced_stop&) {
    if (guarded.failure) std::rethrow_exception(guarded.failure);
  } catch (const nlopt::roundoff_limited&) {
    // The precision of the numbers allows no further progress.
  }
}

}  // namespace fogline::calibrate
