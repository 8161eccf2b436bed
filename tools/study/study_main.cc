// The program of the verb `fogline study`. It answers the paper's open questions with numbers.
#include "tools/study/study.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/process/progress.h"
#include "common/text.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/own_program.h"
#include "tools/cli/verb_program.h"
#include "tools/report/assets.h"
#include "tools/report/study_page.h"
#include "tools/study/claims.h"
#include "tools/study/ensemble/parameter_sets.h"
#include "tools/sweep/engine.h"

namespace fogline::study {
namespace {

/// The name that selects every study.
constexpr std::string_view kAll = "all";

struct StudyArguments {
  std::string name;
  std::filesystem::path out = "studies";
  std::filesystem::path scenarios = "scenario";
  std::string seeds;
  int jobs = sweep::AllCores();
  bool json = false;
};

/// A finished study.
struct Made {
  const Study* study;
  sweep::SeedRange seeds;
  StudyResult result;
};

// Largest number of seeds. It is limited, because the measures of every run stay in memory until
// the study ends.
constexpr std::int64_t kMostSeeds = 100'000;

/// @throws InputError if there are more than kMostSeeds
void RequireFew(const sweep::SeedRange& seeds, const std::string& text) {
  if (seeds.count() <= kMostSeeds) return;
  throw InputError(fmt::format("error: --seeds {}: more than {} seeds", text, kMostSeeds));
}

/// Checks before the runs that the scenarios of the studies exist. @throws InputError
void RequireScenarios(const std::filesystem::path& folder,
                      const std::vector<const Study*>& chosen) {
  std::vector<std::string> names{"paper.json", "dense_fog.json"};
  std::string with = "paper.json and dense_fog.json";
  if (std::ranges::any_of(chosen, &Study::needs_sets)) {
    names.emplace_back(kSetsFile);
    with = fmt::format("paper.json, dense_fog.json and {}", kSetsFile);
  }
  for (const std::string& name : names) {
    const std::filesystem::path file = folder / name;
    std::error_code error;
    if (std::filesystem::exists(file, error)) continue;
    if (error) {
      throw InputError(fmt::format("{}: error: --scenarios: {}", PathText(file), error.message()));
    }
    throw InputError(
        fmt::format("{}: error: --scenarios: there is no such file; the option names the folder "
                    "with {}. In Fogline's sources it is scenario/",
                    PathText(file), with));
  }
}

std::string Names() {
  std::string names;
  for (const Study& study : Studies()) names += fmt::format("{}, ", study.name);
  return names + std::string(kAll);
}

/// The study with this name, or all studies. @throws InputError if there is no such study
std::vector<const Study*> Chosen(const std::string& name) {
  if (name == kAll) {
    std::vector<const Study*> all;
    for (const Study& study : Studies()) all.push_back(&study);
    return all;
  }
  if (const Study* study = FindStudy(name); study != nullptr) return {study};
  throw InputError(fmt::format("error: no study \"{}\"; there are {}", name, Names()));
}

Made Make(const Study& study, const StudyArguments& arguments) {
  const sweep::SeedRange seeds =
      arguments.seeds.empty() ? study.seeds : sweep::ParseSeeds(arguments.seeds);
  std::optional<Progress> progress;
  const StudyContext context{.scenarios = arguments.scenarios,
                             .seeds = seeds,
                             .jobs = arguments.jobs,
                             .progress = [&](std::int64_t done, std::int64_t total) {
                               if (!progress)
                                 progress.emplace(fmt::format("{}: unit", study.name), total);
                               progress->Show(done);
                               return !WasInterrupted();
                             }};
  Made made{.study = &study, .seeds = seeds, .result = {}};
  try {
    made.result = study.run(context);
  } catch (const StudyStopped&) {
    throw Interrupted(
        fmt::format("interrupted in study {}; its files are not written", study.name));
  }
  report::StudySection& section = made.result.section;
  section.claims = CheckClaims(made.result.claims, seeds.count() < study.seeds.count());
  section.name = study.name;
  section.title = study.title;
  section.question = study.question;
  return made;
}

void Write(const std::filesystem::path& path, const std::string& content) {
  AtomicFile file(path);
  file.Write(content);
  file.Finish();
}

/// The command that makes the same files again from the scenarios in the default folder. The
/// command omits --out and --jobs, because the content of the files does not depend on them.
std::string CommandOf(const StudyArguments& arguments) {
  std::string command = fmt::format("fogline study {}", arguments.name);
  if (!arguments.seeds.empty()) command += fmt::format(" --seeds {}", arguments.seeds);
  return command;
}

nlohmann::ordered_json ClaimsJson(const std::vector<report::StudyClaim>& claims) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const report::StudyClaim& claim : claims) {
    json.push_back({{"says", claim.says},
                    {"compared", claim.compared},
                    {"expected", claim.expected},
                    {"found", claim.found},
                    {"state", report::Text(claim.state)}});
  }
  return json;
}

nlohmann::ordered_json ToJson(const StudyArguments& arguments, const std::vector<Made>& all,
                              const std::filesystem::path& page,
                              const std::filesystem::path& text) {
  nlohmann::ordered_json json{{"command", CommandOf(arguments)},
                              {"report", page.string()},
                              {"text", text.string()},
                              {"studies", nlohmann::ordered_json::array()}};
  for (const Made& made : all) {
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    for (const StudyFile& file : made.result.files) {
      files.push_back((arguments.out / file.name).string());
    }
    json["studies"].push_back({{"name", made.study->name},
                               {"seeds", fmt::format("{}:{}", made.seeds.first, made.seeds.last)},
                               {"runs", made.result.runs},
                               {"answer", made.result.section.answer},
                               {"claims", ClaimsJson(made.result.section.claims)},
                               {"files", std::move(files)}});
  }
  return json;
}

void PrintText(const StudyArguments& arguments, const Made& made) {
  fmt::print("{} ({} runs)\n", made.study->title, made.result.runs);
  fmt::print("  {}\n", made.result.section.answer);
  for (const report::StudyClaim& claim : made.result.section.claims) {
    fmt::print("  {:5} {}\n", report::Text(claim.state), claim.says);
  }
  for (const StudyFile& file : made.result.files) {
    fmt::print("{}\n", PathText(arguments.out / file.name));
  }
}

int RunStudy(const StudyArguments& arguments) {
  const std::vector<const Study*> chosen = Chosen(arguments.name);
  if (!arguments.seeds.empty()) RequireFew(cli::ReadSeeds(arguments.seeds), arguments.seeds);
  RequireScenarios(arguments.scenarios, chosen);
  if (const std::string why(report::assets::WhyNoPages()); !why.empty()) {
    throw std::runtime_error(why);
  }
  const OutputFolder folder(arguments.out, "--out");
  WatchInterrupts();
  std::vector<Made> all;
  std::vector<report::StudySection> sections;
  for (const Study* study : chosen) {
    const Made& made = all.emplace_back(Make(*study, arguments));
    for (const StudyFile& file : made.result.files) Write(arguments.out / file.name, file.content);
    sections.push_back(made.result.section);
    if (!arguments.json) PrintText(arguments, made);
  }
  const std::string stem = arguments.name == kAll ? "studies" : arguments.name;
  const std::filesystem::path page = arguments.out / (stem + ".html");
  Write(page, report::MakeStudyPage(CommandOf(arguments), sections));
  const std::filesystem::path text = arguments.out / (stem + ".md");
  Write(text, report::MakeStudyText(CommandOf(arguments), sections));
  if (arguments.json) {
    cli::PrintJson(ToJson(arguments, all, page, text));
  } else {
    fmt::print("{}\n{}\n", PathText(page), PathText(text));
  }
  int exit_code = kDone;
  for (const Made& made : all) {
    const std::string failed = FailedText(made.study->name, made.result.section.claims);
    if (failed.empty()) continue;
    Complain(failed);
    exit_code = kCheckFailed;
  }
  return exit_code;
}

void AddStudy(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand(cli::kStudy.verb, cli::kStudy.purpose);
  const auto arguments = std::make_shared<StudyArguments>();
  verb->add_option("NAME", arguments->name, fmt::format("One of {}", Names()))->required();
  verb->add_option("--out", arguments->out, "Folder for the files, which are replaced")
      ->capture_default_str();
  verb->add_option("--seeds", arguments->seeds,
                   "Seeds A:B, both included (default: the study's own number)");
  verb->add_option("--jobs", arguments->jobs, "Threads")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  verb->add_option("--scenarios", arguments->scenarios,
                   "Folder with paper.json, dense_fog.json and ensemble/, which the studies vary")
      ->capture_default_str();
  verb->add_flag("--json", arguments->json, "Print answers, claims and files as JSON");
  std::string table;
  for (const Study& study : Studies()) {
    table += fmt::format("  {:<11}{} ({} seeds)\n", study.name, study.title, study.seeds.count());
  }
  cli::ShowExitCodes(*verb, {.check_failed = "a claim fails", .interruptible = true});
  verb->footer(fmt::format(
      "Studies:\n{}\n"
      "Writes FOLDER/NAME.csv, and NAME.html and NAME.md with answer, claims, figures and tables\n"
      "(of all: studies.html, studies.md). Each answer rests on claims. The study checks them "
      "against its\n"
      "numbers, and ends with 1 if one of them fails. With fewer seeds than the study's own "
      "number,\n"
      "a claim can stay open. Equal seeds have equal noise in all variants, and differences are\n"
      "paired; intervals are those of 95 %. The files do not depend on --jobs.\n\n"
      "Examples:\n  fogline study policy\n"
      "  fogline study conflict --seeds 1:20 --out /tmp/conflict\n"
      "  fogline study all --out docs/studies",
      table));
  verb->callback([&action, arguments] { action = [arguments] { return RunStudy(*arguments); }; });
}

}  // namespace
}  // namespace fogline::study

int main(int argc, char** argv) {
  return fogline::cli::RunOneVerb(argc, argv, fogline::study::AddStudy);
}
