#include "services/runtime/process/program_options.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "common/exit_code.h"
#include "common/parse_number.h"
#include "common/process/console.h"
#include "common/text.h"

namespace fogline::runtime {

void AddRunIdOption(CLI::App& app, const std::string& name, std::optional<std::int64_t>& run_id,
                    const std::string& help) {
  CLI::Option& option = *app.add_option(name, run_id, help);
  ReadAsDecimal(option);
  option.check(CLI::Range(std::int64_t{1}, std::numeric_limits<std::int64_t>::max()))
      ->check([](const std::string& text) {  // CLI11 changes a number that is too large
        return ParseNumber<std::int64_t>(text)
                   ? std::string()
                   : text + " is no id: a whole number from 1 to 9223372036854775807";
      })
      ->type_name("ID");
}

void ReadAsDecimal(CLI::Option& option) {
  option.transform(CLI::Validator(
      [](std::string& text) -> std::string {
        const bool is_negative = text.starts_with('-');
        const std::string digits = text.substr(is_negative || text.starts_with('+') ? 1 : 0);
        // Texts with other characters are no whole number, or have a prefix such as 0x.
        if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos) {
          return QuoteShort(text) + " is no decimal whole number";
        }
        const std::size_t first = std::min(digits.find_first_not_of('0'), digits.size() - 1);
        text = (is_negative ? "-" : "") + digits.substr(first);
        return "";
      },
      ""));
}

void RefuseEmptyText(CLI::Option& option) {
  option.transform(CLI::Validator(
      [](const std::string& text) { return text.empty() ? "the text is empty" : ""; }, ""));
}

void AddTrafficOptions(CLI::App& app, TrafficOptions& options) {
  app.add_option("--key", options.key_file,
                 "Sign messages with the key in this file, and refuse unsigned ones")
      ->envname(kKeyVariable)
      ->check([](const std::string& file) {
        return file.empty() ? "the name of the key's file is empty" : "";
      });
  app.add_option("--faults", options.faults,
                 "Receive as over a bad network, such as loss=0.3,delay_ms=5");
}

std::string OptionMeant(const CLI::App& command, const std::string& mistyped) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  const std::vector<std::string_view> views(names.begin(), names.end());
  return DidYouMean(Nearest(mistyped, views));
}

std::string WhatIsWrong(const CLI::ParseError& error) {
  // Parts of CLI11's error texts. An error text begins with the name of the option, or with
  // kNoNumber and then the name. In a text with kNoFlag, the name has no dashes.
  static const std::string kNoNumber = "Could not convert: ";
  static const std::string kNoFlag = " was given a disallowed flag override";
  static const std::string kNoValue = " required ";
  const std::string what = error.what();
  if (what.starts_with(kNoNumber)) {
    const std::size_t equals = what.find(" = ");
    return fmt::format("{}: {} is no number",
                       what.substr(kNoNumber.size(), equals - kNoNumber.size()),
                       QuoteShort(what.substr(equals + 3)));
  }
  if (what.ends_with(kNoFlag)) {
    return "--" + what.substr(0, what.size() - kNoFlag.size()) + " takes no value";
  }
  if (what.ends_with(" missing") && what.find(kNoValue) != std::string::npos) {
    return what.substr(0, what.find(": ")) + ": the value is missing";
  }
  return what;
}

ProgramOptions::ProgramOptions(const std::string& name, const std::string& purpose,
                               const std::string& version)
    : app_(std::make_unique<CLI::App>(purpose, name)) {
  app_->set_version_flag("--version", version);
}

ProgramOptions::~ProgramOptions() = default;

void ProgramOptions::Text(const std::string& name, std::string& value, const std::string& help,
                          Help shown) {
  CLI::Option* const option = app_->add_option(name, value, help);
  RefuseEmptyText(*option);
  if (shown == Help::kWithDefault) option->capture_default_str();
}

void ProgramOptions::RequiredText(const std::string& name, std::string& value,
                                  const std::string& help) {
  RefuseEmptyText(*app_->add_option(name, value, help)->required());
}

void ProgramOptions::Flag(const std::string& name, bool& value, const std::string& help) {
  app_->add_flag(name, value, help)->disable_flag_override();
}

void ProgramOptions::Count(const std::string& name, std::size_t& value, const std::string& help,
                           int least, int most) {
  CLI::Option& option = *app_->add_option(name, value, help);
  ReadAsDecimal(option);
  option.check(CLI::Range(least, most))->capture_default_str();
}

void ProgramOptions::Seconds(const std::string& name, double& value, const std::string& help,
                             double most) {
  Number(name, value, help, 0, most);
}

void ProgramOptions::Number(const std::string& name, double& value, const std::string& help,
                            double least, double most) {
  app_->add_option(name, value, help)
      ->check(CLI::Range(least, most))
      ->check([](const std::string& text) {  // CLI::Range accepts NaN
        return std::isnan(std::strtod(text.c_str(), nullptr)) ? "not a number" : "";
      })
      ->capture_default_str();
}

void ProgramOptions::Choice(const std::string& name, std::string& value, const std::string& help,
                            const std::vector<std::string>& choices) {
  app_->add_option(name, value, help)->check(CLI::IsMember(choices))->capture_default_str();
}

void ProgramOptions::RunId(const std::string& name, std::optional<std::int64_t>& run_id,
                           const std::string& help) {
  AddRunIdOption(*app_, name, run_id, help);
}

void ProgramOptions::Traffic(TrafficOptions& options) { AddTrafficOptions(*app_, options); }

void ProgramOptions::Footer(const std::string& text) { app_->footer(text); }

std::optional<int> ProgramOptions::Parse(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app_->exit(asked);
  } catch (const CLI::ParseError& error) {
    std::vector<std::string> unknown = app_->remaining();
    std::erase(unknown, "--");
    std::string what = WhatIsWrong(error);
    if (!unknown.empty()) {
      const std::string word = unknown.front().substr(0, unknown.front().find('='));
      what = word.starts_with("-")
                 ? fmt::format("no option {}{}", QuoteShort(word), OptionMeant(*app_, word))
                 : fmt::format("{} is one argument too many", QuoteShort(word));
    }
    Complain(fmt::format("{0}: error: {1} (see {0} --help)", app_->get_name(), what));
    return kBadInput;
  }
  return std::nullopt;
}

}  // namespace fogline::runtime
