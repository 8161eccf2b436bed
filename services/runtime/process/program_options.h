// The command line of a role, and options that several programs share. The program `fogline` and
// its verbs have other command lines (tools/cli).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/runtime/transport/traffic_options.h"

namespace CLI {
class App;
class Option;
class ParseError;
}  // namespace CLI

namespace fogline::runtime {

/// Adds an option whose value is a whole number from 1 to 2^63 - 1.
/// @param name such as "--run-id"
void AddRunIdOption(CLI::App& app, const std::string& name, std::optional<std::int64_t>& run_id,
                    const std::string& help);

/// Makes a command line read the value of this option, a whole number, as decimal. CLI11 alone
/// reads 010 as 8, and 0x10 as 16.
void ReadAsDecimal(CLI::Option& option);

/// Makes a command line refuse an empty text as the value of this option, before the option's own
/// checks.
void RefuseEmptyText(CLI::Option& option);

/// Adds --key and --faults to a command line.
void AddTrafficOptions(CLI::App& app, TrafficOptions& options);

/// Returns a suggestion for a mistyped option, such as `; did you mean "--log"?`; "" if no option
/// of the command line is similar.
std::string OptionMeant(const CLI::App& command, const std::string& mistyped);

/// Says what is wrong with a command line. Texts of CLI11 that are hard to understand are replaced
/// by plain words, such as `--force takes no value`. The result may have several lines.
std::string WhatIsWrong(const CLI::ParseError& error);

/// The options of a program without verbs. In this library, only the source file of this class
/// includes CLI11, because CLI11's headers take seconds to compile. Each function that adds an
/// option takes a variable. The value of the variable before Parse() is the default, and Parse()
/// stores the value from the command line in the variable.
class ProgramOptions {
 public:
  /// @param name the program's name, such as "fogline-radar"
  /// @param version the text that --version prints
  ProgramOptions(const std::string& name, const std::string& purpose, const std::string& version);
  ~ProgramOptions();

  enum class Help { kAlone, kWithDefault };
  void Text(const std::string& name, std::string& value, const std::string& help,
            Help shown = Help::kAlone);
  /// Adds an option with a text that the user must give.
  void RequiredText(const std::string& name, std::string& value, const std::string& help);
  void Flag(const std::string& name, bool& value, const std::string& help);
  /// Adds an option with a whole number from `least` to `most`.
  void Count(const std::string& name, std::size_t& value, const std::string& help, int least,
             int most);
  /// Adds an option with a time in s, from 0 to `most`.
  void Seconds(const std::string& name, double& value, const std::string& help, double most);
  /// Adds an option with a finite number from `least` to `most`.
  void Number(const std::string& name, double& value, const std::string& help, double least,
              double most);
  /// Adds an option whose value is one of the texts in `choices`.
  void Choice(const std::string& name, std::string& value, const std::string& help,
              const std::vector<std::string>& choices);
  void RunId(const std::string& name, std::optional<std::int64_t>& run_id, const std::string& help);
  void Traffic(TrafficOptions& options);
  /// Sets the text that --help prints after the options. A second call replaces the text.
  void Footer(const std::string& text);

  /// Reads the command line. Prints the help, the version, or what is wrong.
  /// @return the exit code if the program must end now; nullopt if the program goes on
  std::optional<int> Parse(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace fogline::runtime
