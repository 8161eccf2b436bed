#include "tests/soak/soaked_run.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "services/graph.h"
#include "tests/support/children.h"

namespace fogline::test {
namespace {

// The value of Background::Wait() for a process that SIGKILL has ended.
constexpr int kKilled = 128 + SIGKILL;
// The roles that this program starts itself, with their machines. The runner starts the recorder on
// the first machine.
constexpr std::pair<Role, std::size_t> kByHand[] = {
    {Role::kWorld, 1}, {Role::kRadar, 2},  {Role::kLidar, 1},      {Role::kFusion, 2},
    {Role::kAcc, 0},   {Role::kDriver, 1}, {Role::kArbitrator, 2}, {Role::kFollower, 0}};

std::vector<std::string> RunCommandLine(const Experiment& experiment) {
  std::vector<std::string> command{Program("fogline"), "run", experiment.scenario, "--json"};
  command.insert(command.end(), experiment.changes.begin(), experiment.changes.end());
  return command;
}

template <class Values>
const auto& OneOf(const Values& values, std::mt19937_64& random) {
  return values[std::uniform_int_distribution<std::size_t>(0, std::size(values) - 1)(random)];
}

}  // namespace

Experiment Experiment::Draw(std::mt19937_64& random) {
  static const std::vector<std::vector<std::string>> kWith{
      {},
      {"--set", "/human/loses_awareness=true", "--set", "/human/misjudges=true"},
      {"--set", "/arbitrator/take_over/mode=\"requested\""}};
  static const std::vector<std::string> kScenarios{"scenario/paper.json", "scenario/dense_fog.json",
                                                   "scenario/recorded_lead.json"};
  Experiment drawn;
  drawn.scenario = OneOf(kScenarios, random);
  drawn.steps = std::uniform_int_distribution(200, 500)(random);
  drawn.changes = {"--seed", std::to_string(std::uniform_int_distribution(1, 1'000'000)(random)),
                   "--set", fmt::format("/steps={}", drawn.steps)};
  const auto& with = OneOf(kWith, random);
  drawn.changes.insert(drawn.changes.end(), with.begin(), with.end());
  return drawn;
}

Undisturbed RunUndisturbed(const Experiment& experiment) {
  const ScratchFolder folder;
  std::vector<std::string> command = RunCommandLine(experiment);
  command.insert(command.end(), {"--transport", "direct", "--log", folder.File("run.lcm")});
  const Outcome outcome = RunCommand(command);
  if (outcome.code != 0) throw std::runtime_error(outcome.err);
  return {nlohmann::json::parse(outcome.out).at("digest"),
          std::filesystem::file_size(folder.File("run.lcm"))};
}

SoakedRun::SoakedRun(const Experiment& experiment, Place place, std::vector<std::string> options)
    : options_(std::move(options)) {
  if (place != Place::kLoopback) options_.insert(options_.end(), {"--lcm-url", kUrl});
  if (place == Place::kThreeMachines) {
    lab_.emplace(3);
    for (const auto& [role, machine] : kByHand) {
      options_.insert(options_.end(), {"--external", std::string(NameOf(role))});
    }
    for (std::size_t i = 0; i < std::size(kByHand); ++i) StartRole(i);
  } else {
    machine_.emplace("desk");
    machine_->Do(
        "ip link add eth0 type veth peer name far; ip link set far up; ip link set eth0 up;"
        "ip addr add 192.0.2.1/24 dev eth0; ip route add default via 192.0.2.2");
  }
  std::vector<std::string> command = RunCommandLine(experiment);
  command.insert(command.end(), {"--log", log_});
  StartRunner(command);
}

void SoakedRun::StartRunner(const std::vector<std::string>& arguments) {
  std::vector<std::string> command = arguments;
  command.insert(command.end(), options_.begin(), options_.end());
  command_ = fmt::format("{}", fmt::join(command, " "));
  run_ = std::make_unique<Background>(On(0, command));
}

void SoakedRun::StartRole(std::size_t role) {
  const auto& [which, machine] = kByHand[role];
  const std::string program = Program(fmt::format("fogline-{}", NameOf(which)));
  auto process = std::make_unique<Background>(On(machine, {program, "--lcm-url", kUrl}));
  if (role < roles_.size()) {
    roles_[role] = std::move(process);
  } else {
    roles_.push_back(std::move(process));
  }
}

std::vector<std::string> SoakedRun::On(std::size_t machine,
                                       const std::vector<std::string>& command) const {
  return lab_ ? (*lab_)[machine].On(command) : machine_->On(command);
}

std::vector<const Machine*> SoakedRun::machines() const {
  if (machine_) return {&*machine_};
  std::vector<const Machine*> all;
  for (const Machine& machine : lab_->machines()) all.push_back(&machine);
  return all;
}

bool SoakedRun::WaitForShare(double share, const Undisturbed& whole) {
  const auto bytes = static_cast<std::uintmax_t>(share * static_cast<double>(whole.log_bytes));
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (Running() && std::chrono::steady_clock::now() < end) {
    if (GrowsTo(bytes, log_, std::chrono::seconds(1))) return Running();
  }
  return false;
}

std::vector<pid_t> SoakedRun::Processes() const {
  std::vector<pid_t> all{run_->pid()};
  for (const pid_t child : ChildrenOf(run_->pid())) all.push_back(child);
  for (const auto& role : roles_) all.push_back(role->pid());
  return all;
}

bool SoakedRun::SignalAChild(int signal, std::mt19937_64& random) const {
  const auto own = ChildrenOf(run_->pid());
  return !own.empty() && kill(OneOf(own, random), signal) == 0;
}

bool SoakedRun::KillARole(std::mt19937_64& random) {
  if (roles_.empty()) return SignalAChild(SIGKILL, random);
  const auto role = std::uniform_int_distribution<std::size_t>(0, roles_.size() - 1)(random);
  roles_[role]->Signal(SIGKILL);
  const bool killed = roles_[role]->Wait() == kKilled;
  StartRole(role);
  return killed;
}

bool SoakedRun::StopARole(std::mt19937_64& random) const { return SignalAChild(SIGSTOP, random); }

bool SoakedRun::KillTheRunnerAndResume() {
  run_->Signal(SIGKILL);
  const bool killed = run_->Wait() == kKilled;
  StartRunner({Program("fogline"), "run", "--json", "--resume", log_});
  return killed;
}

Outcome SoakedRun::Finish() {
  const int code = run_->Wait(kPatience);
  return {code, run_->Out(), run_->Err()};
}

}  // namespace fogline::test
