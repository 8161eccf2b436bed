// A session in the terminal: prompts on stdout, one answer per line from stdin.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/trials/desk/desk.h"

namespace fogline::trials {

class TerminalDesk final : public Desk {
 public:
  void WaitForBegin(const Next& next) override;
  void RunOpens(std::int64_t, const std::string&) override {}
  void RunBegins(Speaker&) override {}
  void RunGoesOn() override {}
  void RunEnded() override {}
  std::vector<Answer> Ask(const Next& after, const QuestionnaireSection& questionnaire) override;
  void Finish() override;

 private:
  /// Reads the next line of stdin, and returns it without its line feed. The caller has printed a
  /// prompt before. If no line comes, the function prints a line feed after the prompt.
  /// @throws Interrupted; std::runtime_error at the end of stdin
  std::string ReadLine();
  std::string WaitForLine();

  std::string unread_;
};

}  // namespace fogline::trials
