#include "services/models/sumo/sumo_traffic.h"

#include <libsumo/libsumo.h>

#include <algorithm>
#include <exception>
#include <iostream>
#include <semaphore>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "common/errors.h"

namespace fogline::sumo {
namespace {

// Guards the only simulation of this process. A mutex cannot be used, because one thread may begin
// a run and another thread may end this run.
std::binary_semaphore simulation(1);

constexpr double kMicrosPerSecond = 1e6;
constexpr std::int64_t kSeeds = std::int64_t{1} << 31;  // SUMO's seed is an int of 32 bits
constexpr const char* kRoute = "fogline";
constexpr const char* kType = "DEFAULT_VEHTYPE";
constexpr const char* kPrefix = "fogline.";
// SUMO removes a car at the end of its route. So Step() refuses a host that is nearer to the end of
// its lane than this distance.
constexpr double kBeforeTheEnd_m = 1.0;
// Bits of SUMO's speed mode and lane change mode. If no bit is set, a car follows only the caller's
// commands.
constexpr int kObey = 0;
constexpr double kFastest_mps = 100.0;

/// Keeps the text that SUMO writes to std::cerr while this object exists. SUMO's exceptions often
/// contain only "Process Error", and SUMO writes the reason to std::cerr. Fogline itself does not
/// use std::cerr.
class KeptErrors {
 public:
  KeptErrors() : before_(std::cerr.rdbuf(kept_.rdbuf())) {}
  ~KeptErrors() { std::cerr.rdbuf(before_); }
  KeptErrors(const KeptErrors&) = delete;
  KeptErrors& operator=(const KeptErrors&) = delete;

  std::string Text() const { return kept_.str(); }

 private:
  std::ostringstream kept_;
  std::streambuf* before_;
};

bool IsFogline(const std::string& car) { return car.starts_with(kPrefix); }

/// Up to five names, for a message.
std::string Some(std::vector<std::string> names) {
  constexpr std::size_t kMost = 5;
  const std::size_t count = names.size();
  std::ranges::sort(names);
  names.resize(std::min(count, kMost));
  return fmt::format("{}{}", fmt::join(names, ", "), count > kMost ? ", ..." : "");
}

}  // namespace

void SumoTraffic::Close() {
  if (!running_) return;
  running_ = false;
  try {
    libsumo::Simulation::close();
  } catch (const std::exception&) {
    // The simulation has failed before. The caller reports that first error, so this error is
    // ignored.
  }
  files_.reset();
  path_.reset();
  simulation.release();
}

models::LeaderInTraffic SumoTraffic::Begin(std::span<const models::Motion> cars) {
  Close();
  simulation.acquire();
  running_ = true;
  const KeptErrors said;
  try {
    Load();
    RequireCarBehindWhichToBegin();
    Enter(cars);
    const std::optional<models::LeaderInTraffic> ahead = Ahead(cars.front());
    if (!ahead || ahead_ != setup_.behind) {
      throw InputError(
          fmt::format("/lead/sumo/behind: between the host and \"{}\" is another car: {}",
                      setup_.behind, ahead_));
    }
    return *ahead;
  } catch (const InputError&) {
    Close();
    throw;
  } catch (const std::exception& error) {
    const std::string why = WhyNot(error.what(), said.Text());
    Close();
    throw InputError("/lead/sumo: SUMO: " + why);
  }
}

void SumoTraffic::Load() {
  files_.emplace(setup_);
  const double step_s = static_cast<double>(setup_.step_us) / kMicrosPerSecond;
  libsumo::Simulation::start(
      {"sumo", "--net-file", files_->net.path(), "--route-files", files_->routes.path(),
       "--no-warnings", "--no-step-log", "--xml-validation", "never", "--step-length",
       fmt::format("{}", step_s),
       // The acceleration is constant within a step, as in services/models/vehicle/motion.h.
       "--step-method.ballistic", "--seed", fmt::format("{}", setup_.seed % kSeeds),
       // With these options, SUMO does not remove a car that stands for a long time, or that is too
       // close to another car.
       "--time-to-teleport", "-1", "--collision.action", "none"});
  libsumo::Simulation::step(setup_.start_s);
}

/// The first error that SUMO has written, in one line. If SUMO has written no error, the result is
/// the error of SUMO's library. In the text, "net" and "routes" (the names in the scenario) replace
/// the names of the files.
std::string SumoTraffic::WhyNot(const std::string& error, const std::string& said) const {
  constexpr std::string_view kError = "Error: ";
  std::string why = said.starts_with(kError) ? said.substr(kError.size()) : said;
  why.resize(std::min({why.find("\n\n"), why.find("\nError: "), why.size()}));
  while (why.ends_with('\n')) why.pop_back();
  if (why.empty()) why = error;
  std::erase(why, '\n');  // the next line of SUMO's text begins with a space
  if (!files_) return why;
  for (const auto& [file, name] :
       {std::pair(files_->net.path(), "net"), std::pair(files_->routes.path(), "routes")}) {
    const std::size_t at = why.find(file);
    if (at != std::string::npos) why.replace(at, file.size(), name);
  }
  return why;
}

void SumoTraffic::RequireCarBehindWhichToBegin() const {
  const std::vector<std::string> cars = libsumo::Vehicle::getIDList();
  if (std::ranges::find(cars, setup_.behind) != cars.end()) return;
  throw InputError(fmt::format("/lead/sumo/behind: SUMO has no car \"{}\" at {} s; it has {}",
                               setup_.behind, setup_.start_s, cars.empty() ? "none" : Some(cars)));
}

/// Puts Fogline's cars on the road. The host begins behind a car of SUMO, with the gap that the
/// scenario gives.
void SumoTraffic::Enter(std::span<const models::Motion> cars) {
  const std::string& behind = setup_.behind;
  const std::string lane = libsumo::Vehicle::getLaneID(behind);
  const std::vector<std::string> route = libsumo::Vehicle::getRoute(behind);
  path_.emplace(route, lane);
  const auto at = std::ranges::find(path_->lanes(), lane, &LanePath::Lane::id);
  const double rear_m =
      at->begin_m + libsumo::Vehicle::getLanePosition(behind) - libsumo::Vehicle::getLength(behind);
  origin_m_ = rear_m - setup_.host_gap_m - cars.front().position_m;
  if (Along(cars.back()) - setup_.length_m < 0) {
    throw InputError(
        fmt::format("/lead/sumo/behind: the road ends {:.1f} m behind \"{}\", but the host and the "
                    "cars behind it need {:.1f} m",
                    rear_m, behind, rear_m - Along(cars.back()) + setup_.length_m));
  }
  libsumo::Route::add(kRoute, route);
  names_.clear();
  for (std::size_t i = 0; i < cars.size(); ++i) {
    const std::string& name = names_.emplace_back(
        i == 0 ? fmt::format("{}host", kPrefix) : fmt::format("{}follower.{}", kPrefix, i));
    libsumo::Vehicle::add(name, kRoute, kType);
    libsumo::Vehicle::setLength(name, setup_.length_m);
    libsumo::Vehicle::setMaxSpeed(name, kFastest_mps);
    libsumo::Vehicle::setSpeedMode(name, kObey);
    libsumo::Vehicle::setLaneChangeMode(name, kObey);
  }
  Move(cars);
  ahead_ = behind;
}

/// Gives SUMO the places and speeds of Fogline's cars. moveTo() leaves a car with the speed that
/// SUMO computed. So setPreviousSpeed() must come after moveTo(), to set the right speed.
/// moveToXY() is not used, because it would move a car only at the end of SUMO's next step (SUMO's
/// issues 8661 and 11091).
void SumoTraffic::Move(std::span<const models::Motion> cars) const {
  for (std::size_t i = 0; i < cars.size(); ++i) {
    const LanePlace place = path_->At(Along(cars[i]));
    libsumo::Vehicle::moveTo(names_[i], place.lane, place.position_m);
    libsumo::Vehicle::setPreviousSpeed(names_[i], cars[i].speed_mps);
  }
}

/// The car on the path whose front bumper is the nearest one ahead of the host's front bumper.
std::optional<models::LeaderInTraffic> SumoTraffic::Ahead(const models::Motion& host) {
  const double host_m = Along(host);
  std::string nearest;
  double nearest_m = 0;
  for (const LanePath::Lane& lane : path_->lanes()) {
    if (lane.begin_m + lane.length_m <= host_m) continue;
    for (const std::string& car : libsumo::Lane::getLastStepVehicleIDs(lane.id)) {
      if (IsFogline(car)) continue;
      const double front_m = lane.begin_m + libsumo::Vehicle::getLanePosition(car);
      if (front_m <= host_m || (!nearest.empty() && front_m >= nearest_m)) continue;
      nearest = car;
      nearest_m = front_m;
    }
    if (!nearest.empty()) break;
  }
  const bool changed = nearest != ahead_;
  ahead_ = nearest;
  if (nearest.empty()) return std::nullopt;
  return models::LeaderInTraffic{
      .rear_m = nearest_m - libsumo::Vehicle::getLength(nearest) - origin_m_,
      .speed_mps = libsumo::Vehicle::getSpeed(nearest),
      .acceleration_mps2 = libsumo::Vehicle::getAcceleration(nearest),
      .changed = changed};
}

std::optional<models::LeaderInTraffic> SumoTraffic::Step(std::span<const models::Motion> cars) {
  if (!running_) throw std::logic_error("SUMO: no run has begun");
  if (Along(cars.front()) > path_->length_m() - kBeforeTheEnd_m) {
    throw std::runtime_error(fmt::format(
        "SUMO: the host reaches the end of its lane, {:.1f} m after the place at which it began",
        path_->length_m() - origin_m_));
  }
  const KeptErrors said;
  try {
    for (std::size_t i = 0; i < cars.size(); ++i) {
      libsumo::Vehicle::setSpeed(names_[i], cars[i].speed_mps);
    }
    libsumo::Simulation::step();
    Move(cars);
    return Ahead(cars.front());
  } catch (const std::exception& error) {
    throw std::runtime_error("SUMO: " + WhyNot(error.what(), said.Text()));
  }
}

}  // namespace fogline::sumo

extern "C" {

[[gnu::visibility("default")]] const char* FoglineSumoVersion() {
  static const std::string version = libsumo::Simulation::getVersion().second;
  return version.c_str();
}

[[gnu::visibility("default")]] fogline::models::Traffic* FoglineSumoTraffic(
    const fogline::models::TrafficSetup& setup) {
  return new fogline::sumo::SumoTraffic(setup);
}
}
