// Runs of real processes under random faults, several at the same time. Every digest must equal the
// digest of the undisturbed run.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/exit_code.h"
#include "tests/soak/faults.h"
#include "tests/soak/soaked_run.h"
#include "tools/cli/help.h"
#include "tools/sweep/plan.h"

namespace fogline::test {
namespace {

using SteadyClock = std::chrono::steady_clock;

// Exit code if this process may not make simulated machines.
constexpr int kNoMachines = 4;

// Limits of the time and of the number of runs: a year, and more runs than are possible in a year.
constexpr double kMostMinutes = 525'600;
constexpr std::int64_t kMostRuns = 1'000'000'000;
// The smallest value of --minutes. This time is over before a run can begin, so a test uses it for
// a soak without runs.
constexpr double kLeastMinutes = 1e-9;
// Limits of the duration of a fault.
constexpr double kShortestFault_s = 0.1;
constexpr double kLongestFault_s = 60;

// With --each, a kind of fault gets at most this many further runs until a fault of this kind hits
// a run. On a busy machine a run can end before its fault begins.
constexpr int kMostFurtherRuns = 5;

volatile std::sig_atomic_t interrupted = 0;

struct Options {
  double minutes = 60;
  std::int64_t runs = 0;  // 0: as many as the time allows
  std::int64_t each = 0;  // number of runs of each kind; 0: `runs` is the limit
  std::int64_t first = 0;
  std::uint64_t seed = 1;
  std::string only;
  unsigned jobs = 2 * std::max(1U, std::thread::hardware_concurrency());
  Limits limits;
};

/// The results of the runs with one kind of fault.
struct Tally {
  std::int64_t runs = 0;
  std::int64_t struck = 0;  // faults that hit a run
  std::int64_t failed = 0;
  std::int64_t repairs = 0;
  std::int64_t restarts = 0;
  double longest_s = 0;
};

struct Ended {
  std::int64_t struck = 0;
  std::int64_t repairs = 0;
  std::int64_t restarts = 0;
  std::string failure;  // "" if the digest is right
};

Ended SoakOnce(const FaultKind& kind, std::uint64_t seed, std::int64_t number,
               const Limits& limits) {
  std::seed_seq words{seed, static_cast<std::uint64_t>(number)};
  std::mt19937_64 random(words);
  const Experiment experiment = Experiment::Draw(random);
  const Undisturbed undisturbed = RunUndisturbed(experiment);
  std::vector<std::string> options = kind.options(random);
  // With --pace 10 the run is so slow that a fault of 0.1 s covers many steps.
  options.insert(options.end(), {"--pace", "10", "--stall-timeout", "90"});
  const bool three = kind.three_machines && (!kind.alone || random() % 3 == 0);
  std::vector<double> shares;
  if (kind.most_strikes > 0) {
    shares.resize(std::uniform_int_distribution<std::size_t>(
        1, static_cast<std::size_t>(kind.most_strikes))(random));
  }
  for (double& share : shares) share = std::uniform_real_distribution(0.02, 0.95)(random);
  std::ranges::sort(shares);

  SoakedRun run(experiment, three ? SoakedRun::Place::kThreeMachines : *kind.alone, options);
  Ended ended;
  for (const double share : shares) {
    if (!run.WaitForShare(share, undisturbed)) break;
    if (kind.strike(run, random, limits)) ++ended.struck;
  }
  const std::string command = run.command();
  const Outcome outcome = run.Finish();
  const auto result = nlohmann::json::parse(outcome.out, nullptr, false);
  if (outcome.code != 0 || !result.is_object()) {
    ended.failure = fmt::format("exit code {}: {}\n{}", outcome.code, command, outcome.err);
  } else if (result.value("digest", "") != undisturbed.digest) {
    ended.failure = fmt::format("digest {} in place of {}: {}\n{}", result.value("digest", ""),
                                undisturbed.digest, command, outcome.err);
  }
  if (result.is_object()) {
    ended.repairs = result.value("repairs", 0);
    for (const auto& role : result.value("restarts", nlohmann::json::array())) {
      ended.restarts += role.value("count", 0);
    }
  }
  return ended;
}

class Soak {
 public:
  explicit Soak(const Options& options) : options_(options), next_(options.first) {
    for (const FaultKind& kind : FaultKinds()) {
      if (options.only.empty() || kind.name == options.only) kinds_.push_back(&kind);
    }
    tallies_.resize(kinds_.size());
    runs_ = options.each > 0 ? options.each * NumKinds() : options.runs;
  }

  int Run() {
    WorkInAllJobs();
    for (int i = 0; i < kMostFurtherRuns && options_.each > 0 && NumMissed() > 0; ++i) {
      only_missed_ = true;
      next_ = options_.first + runs_;
      runs_ += NumKinds();
      WorkInAllJobs();
    }
    PrintTallies();
    if (interrupted != 0) return kInterrupted;
    return failed_ == 0 && Complains() == 0 ? kDone : kCheckFailed;
  }

 private:
  double Elapsed_s() const {
    return std::chrono::duration<double>(SteadyClock::now() - began_).count();
  }

  bool Over(std::int64_t number) const {
    if (interrupted != 0) return true;
    return runs_ > 0 ? number >= options_.first + runs_ : Elapsed_s() > 60 * options_.minutes;
  }

  std::int64_t NumKinds() const { return static_cast<std::int64_t>(kinds_.size()); }

  /// Whether there were runs of this kind, but no fault of this kind hit a run. Always false for a
  /// kind that causes no fault, or causes its faults by options of `fogline run` (most_strikes 0).
  bool Missed(std::size_t kind) const {
    const Tally& tally = tallies_[kind];
    return kinds_[kind]->most_strikes > 0 && tally.runs > 0 && tally.struck == 0;
  }
  std::int64_t NumMissed() const {
    std::int64_t missed = 0;
    for (std::size_t kind = 0; kind < kinds_.size(); ++kind) missed += Missed(kind) ? 1 : 0;
    return missed;
  }

  void WorkInAllJobs() {
    std::vector<std::thread> jobs;
    for (unsigned i = 0; i < options_.jobs; ++i) jobs.emplace_back([this] { Work(); });
    for (std::thread& job : jobs) job.join();
  }

  void Work() {
    for (std::int64_t number = next_++; !Over(number); number = next_++) {
      const std::size_t kind = static_cast<std::size_t>(number) % kinds_.size();
      if (only_missed_ && !Missed(kind)) continue;
      const double began_s = Elapsed_s();
      Ended ended;
      try {
        ended = SoakOnce(*kinds_[kind], options_.seed, number, options_.limits);
      } catch (const std::exception& error) {
        ended.failure = error.what();
      }
      if (interrupted == 0) Add(kind, number, ended, Elapsed_s() - began_s);
    }
  }

  void Add(std::size_t kind, std::int64_t number, const Ended& ended, double took_s) {
    const std::lock_guard lock(mutex_);
    Tally& tally = tallies_[kind];
    ++tally.runs;
    tally.struck += ended.struck;
    tally.repairs += ended.repairs;
    tally.restarts += ended.restarts;
    tally.longest_s = std::max(tally.longest_s, took_s);
    ++done_;
    if (!ended.failure.empty()) {
      ++tally.failed;
      ++failed_;
      fmt::print(
          "run {} ({}) failed; again: tools/soak --seed {} --first {} --runs 1 --freeze {}"
          " --partition {}{}\n{}\n",
          number, kinds_[kind]->name, options_.seed, number, options_.limits.freeze_s,
          options_.limits.partition_s, options_.only.empty() ? "" : " --only " + options_.only,
          ended.failure);
      std::fflush(stdout);
    }
    fmt::print(stderr, "{:.1f} min: {} runs, {} failed\n", Elapsed_s() / 60, done_, failed_);
  }

  void PrintTallies() const {
    fmt::print("{:<10} {:>6} {:>7} {:>8} {:>9} {:>9} {:>8}  {}\n", "kind", "runs", "failed",
               "strikes", "restarts", "repairs", "longest", "what");
    for (std::size_t i = 0; i < kinds_.size(); ++i) {
      const Tally& tally = tallies_[i];
      fmt::print("{:<10} {:>6} {:>7} {:>8} {:>9} {:>9} {:>6.0f} s  {}\n", kinds_[i]->name,
                 tally.runs, tally.failed, tally.struck, tally.restarts, tally.repairs,
                 tally.longest_s, kinds_[i]->what);
    }
    fmt::print("{} runs in {:.1f} min, {} failed\n", done_, Elapsed_s() / 60, failed_);
  }

  /// Prints an error if no run was made, and one error for each kind of fault that hit no run.
  /// @return the number of errors
  int Complains() const {
    if (done_ == 0) fmt::print(stderr, "soak: error: no run was made: --minutes is too short\n");
    int complaints = done_ == 0 ? 1 : 0;
    for (std::size_t i = 0; i < kinds_.size(); ++i) {
      if (!Missed(i)) continue;
      fmt::print(stderr, "soak: error: {}: {} runs, and no fault hit one of them\n",
                 kinds_[i]->name, tallies_[i].runs);
      ++complaints;
    }
    return complaints;
  }

  const Options options_;
  std::int64_t runs_ = 0;     // 0: as many as the time allows
  bool only_missed_ = false;  // true: only kinds whose faults have hit no run get runs
  const SteadyClock::time_point began_ = SteadyClock::now();
  std::vector<const FaultKind*> kinds_;
  std::atomic<std::int64_t> next_;
  std::mutex mutex_;  // guards the members below
  std::vector<Tally> tallies_;
  std::int64_t done_ = 0;
  std::int64_t failed_ = 0;
};

std::string TextOfKinds() {
  std::string text = "Kinds of runs, in turn:\n";
  for (const FaultKind& kind : FaultKinds()) {
    text += fmt::format("  {:<10} {}\n", kind.name, kind.what);
  }
  return text;
}

int Main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "Makes runs of Fogline's processes under random faults, and compares every digest with that\n"
      "of a run without faults. Each run has machines (network namespaces) of its own. Needs root\n"
      "and nftables.",
      "soak"};
  app.add_option("--minutes", options.minutes, "Time in which runs are started, in minutes")
      ->check(cli::NumberIn(kLeastMinutes, kMostMinutes))
      ->capture_default_str();
  auto* runs = app.add_option("--runs", options.runs, "Number of runs, instead of a time")
                   ->check(CLI::Range(std::int64_t{1}, kMostRuns));
  app.add_option("--each", options.each,
                 fmt::format("Number of runs of each kind, instead of a time. A kind whose faults\n"
                             "hit none of them gets up to {} more runs",
                             kMostFurtherRuns))
      ->check(CLI::Range(std::int64_t{1}, kMostRuns))
      ->excludes(runs);
  app.add_option("--first", options.first,
                 "Number of the first run, from which it draws its faults")
      ->check(CLI::Range(std::int64_t{0}, kMostRuns));
  app.add_option("--seed", options.seed, "Seed of the faults of all runs")
      ->check(CLI::Range(std::int64_t{0}, sweep::kMaxSeed))
      ->capture_default_str();
  std::vector<std::string> names;
  for (const FaultKind& kind : FaultKinds()) names.emplace_back(kind.name);
  app.add_option("--only", options.only, "Only runs of this kind")->check(CLI::IsMember(names));
  app.add_option("--jobs", options.jobs, "Runs at once")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--freeze", options.limits.freeze_s, "Longest freeze, in s")
      ->check(cli::NumberIn(kShortestFault_s, kLongestFault_s))
      ->capture_default_str();
  app.add_option("--partition", options.limits.partition_s, "Longest partition, in s")
      ->check(cli::NumberIn(kShortestFault_s, kLongestFault_s))
      ->capture_default_str();
  app.footer(
      TextOfKinds() +
      "\nExit codes: 0 all digests equal, 1 one differs, a run failed, no run was made, or no\n"
      "fault hit any run of a kind, 2 bad usage, 4 machines cannot be made here, 130\n"
      "interrupted.\n\n"
      "Examples:\n  tools/soak\n  tools/soak --minutes 5 --only freeze");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "soak: error: {} (see tools/soak --help)\n", error.what());
    return kBadInput;
  }
  if (const std::string why = WhyNoMachines(); !why.empty()) {
    fmt::print(stderr, "soak: error: cannot make machines: {}\n", why);
    if (std::getenv("FOGLINE_TEST_NO_SKIP") != nullptr) return kCheckFailed;
    return kNoMachines;
  }
  struct sigaction action {};
  action.sa_handler = [](int) { interrupted = 1; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  return Soak(options).Run();
}

}  // namespace
}  // namespace fogline::test

int main(int argc, char** argv) { return fogline::test::Main(argc, argv); }
