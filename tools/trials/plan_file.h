// Reads and checks the file of an experiment with people.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/io/loader.h"
#include "scenario/sections/plans/experiment.h"

namespace fogline::trials {

/// Reads an experiment. The scenarios of its conditions are not read.
/// @param name of the file, for messages
/// @throws ScenarioError with every mistake of the file
ExperimentPlan ParsePlan(std::string_view text, std::string_view name = "experiment");

/// An experiment as it was read from a file.
struct PlanFile {
  std::filesystem::path file;
  std::string text;
  std::string hash;  // BLAKE2b-256 of the text, hexadecimal
  ExperimentPlan plan;
};

/// Reads an experiment, and checks that the scenario of each condition can be run.
/// @throws ScenarioError with every mistake of the file; if it has none, with every mistake of its
///     scenarios. A mistake in a scenario's file is reported at the first condition with this file
PlanFile LoadPlan(const std::filesystem::path& file);

/// The reason why trials with this scenario cannot run at this speed; "" if they can.
/// @param speed simulated seconds per second
std::string WhyNotAt(double speed, const Scenario& scenario);

/// The scenario of a condition.
/// @param more overrides that are applied after those of the condition
/// @throws InputError that names the experiment's file and the condition
Scenario LoadCondition(const PlanFile& file, const ConditionSection& condition,
                       const std::vector<std::string>& more = {});

}  // namespace fogline::trials
