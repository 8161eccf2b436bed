// A session in the browser: one page for the participant and one for the experimenter, at different
// addresses. The participant's page shows the title of the run, the questions, and nothing else: no
// condition, no threshold, no truth. If the participant drives, the page opens the seat of
// fogline-web for the run. After the run the seat opens the page again. The experimenter's page
// shows the condition and what has happened, and accepts markers. Each address has a token of its
// own. So the participant cannot guess the address of the experimenter, and other users of the
// machine cannot guess either address.
//
// This process serves both pages itself, and writes the answers itself. So no answer depends on
// fogline-web, which only shows the run and serves the seat.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "services/runtime/transport/traffic_options.h"
#include "tools/trials/desk/desk.h"

namespace fogline::trials {

struct PageOptions {
  /// The numeric IPv4 address at which other machines may open the pages. "": this machine only.
  std::string listen;
  std::uint16_t participant_port = 0;   // 0: any free port
  std::uint16_t experimenter_port = 0;  // 0: any free port
  std::uint16_t seat_port = 0;          // port of fogline-web; 0: any free port
  runtime::TrafficOptions traffic;      // options of the runs
};

class PageDesk final : public Desk {
 public:
  /// @throws InputError if a port that the user chose is not free; std::runtime_error if the desk
  /// cannot listen
  explicit PageDesk(const PageOptions& options);
  ~PageDesk() override;

  /// The address of a page with its token, such as "http://127.0.0.1:40001/#token=...".
  std::string participant_address() const;
  std::string experimenter_address() const;

  void WaitForBegin(const Next& next) override;
  void RunOpens(std::int64_t run_id, const std::string& url) override;
  void RunBegins(Speaker& speaker) override;
  void RunGoesOn() override;
  void RunEnded() override;
  std::vector<Answer> Ask(const Next& after, const QuestionnaireSection& questionnaire) override;
  void Finish() override;

 private:
  class Pages;
  std::unique_ptr<Pages> pages_;
  bool seat_ = false;  // whether the participant drives in the next or the current run
};

}  // namespace fogline::trials
