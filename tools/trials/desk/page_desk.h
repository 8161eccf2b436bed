// A session in the browser: one page for the participant and one for the experimenter, at different
// addresses. The participant's page shows the title of the run, the questions, and nothing else: no
// condition, no threshold, no truth. The experimenter's page shows the condition and what has
// happened, and takes markers. Its address has a token, so the participant cannot guess it.
//
// This process serves both pages itself, and writes the answers itself. So no answer depends on
// fogline-web, which only shows the run.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "services/runtime/transport/traffic_options.h"
#include "tools/trials/desk/desk.h"

namespace fogline::trials {

struct PageOptions {
  std::uint16_t participant_port = 0;   // 0: any free port
  std::uint16_t experimenter_port = 0;  // 0: any free port
  runtime::TrafficOptions traffic;      // of the runs
};

class PageDesk final : public Desk {
 public:
  /// Listens on this machine only.
  /// @throws std::runtime_error if a port is not free
  explicit PageDesk(const PageOptions& options);
  ~PageDesk() override;

  /// "http://127.0.0.1:40001/", and the same with a token.
  std::string participant_address() const;
  std::string experimenter_address() const;

  void WaitForBegin(const Next& next) override;
  void RunBegins(const std::string& url, Speaker& speaker) override;
  void RunGoesOn() override;
  void RunEnded() override;
  std::vector<Answer> Ask(const QuestionnaireSection& questionnaire) override;
  void Finish() override;

 private:
  class Pages;
  std::unique_ptr<Pages> pages_;
};

}  // namespace fogline::trials
