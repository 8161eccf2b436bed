#include "tools/trials/desk/page_desk.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/core.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <nlohmann/json.hpp>

#include "common/clock.h"
#include "common/errors.h"
#include "common/process/console.h"
#include "services/runtime/transport/tcpq_url.h"
#include "tools/processes/page_seat.h"
#include "tools/trials/desk/page_state.h"
#include "tools/trials/desk/run_page.h"
#include "tools/web/server/server.h"

namespace fogline::web {
/// The files of the participant's page and of the experimenter's page. embed.cmake writes this
/// function.
std::span<const Asset> TrialAssets();
}  // namespace fogline::web

namespace fogline::trials {
namespace {

namespace asio = boost::asio;

// Interval at which a wait checks for Ctrl-C.
constexpr Duration kWakeEvery = milliseconds(50);
// Time limit for closing all connections at the end.
constexpr milliseconds kEndLimit(600);

/// The files of a page. Its main file is at "/". Files that only the other page needs are not
/// included.
std::vector<web::Asset> FilesOf(std::string_view main, std::string_view script) {
  std::vector<web::Asset> files;
  for (web::Asset asset : web::TrialAssets()) {
    if (asset.path == main) {
      asset.path = "/index.html";
      files.push_back(asset);
    } else if (asset.path == script || asset.path == "/link.js" || asset.path == "/trials.css") {
      files.push_back(asset);
    }
  }
  return files;
}

/// The clients of one of the pages.
class PageView final : public web::View {
 public:
  using Read = std::function<void(web::Client&, std::string_view)>;
  using State = std::function<std::string()>;
  /// @param state gives the state as JSON
  PageView(Read read, State state) : read_(std::move(read)), state_(std::move(state)) {}

  void Show() {
    const std::string state = state_();
    for (const auto& [id, client] : clients_) client->Send(web::TextFrame(state));
  }
  void Opened(web::Client& client) override {
    clients_[client.id()] = &client;
    client.Send(web::TextFrame(state_()));
  }
  void Received(web::Client& client, std::string_view bytes, bool binary) override {
    if (!binary) read_(client, bytes);
  }
  void Idle(web::Client&) override {}
  void Closed(web::Client& client) override { clients_.erase(client.id()); }
  /// Tells a client why its frame was refused.
  void Refuse(web::Client& client, const std::string& why) const {
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(state_());
    json["refused"] = why;
    client.Send(web::TextFrame(json.dump()));
  }

 private:
  Read read_;
  State state_;
  std::map<std::uint64_t, web::Client*> clients_;
};

std::string AddressOf(const PageOptions& options) {
  return options.listen.empty() ? "127.0.0.1" : options.listen;
}

/// An address with a port, and the option that sets the port.
struct Place {
  runtime::tcpq::Endpoint endpoint;  // port 0: any free port
  const char* option;

  std::string OptionText() const { return fmt::format("{} {}", option, endpoint.port); }
};

/// Starts a server. @throws as runtime::tcpq::ThrowCannotListen()
std::unique_ptr<web::Server> Listen(asio::io_context& context, const Place& place,
                                    std::span<const web::Asset> files, web::View& view) {
  try {
    return std::make_unique<web::Server>(context,
                                         web::ServerOptions{.address = place.endpoint.address,
                                                            .port = place.endpoint.port,
                                                            .token = web::DrawToken(),
                                                            .origins = {}},
                                         files, view);
  } catch (const boost::system::system_error& error) {
    runtime::tcpq::ThrowCannotListen(place.endpoint, place.OptionText(), error.code());
  }
}

RunPageOptions ForRuns(const PageOptions& options) {
  return {.address = AddressOf(options),
          .port = options.seat_port,
          .traffic = runtime::ToArguments({.key_file = options.traffic.key_file, .faults = ""})};
}

}  // namespace

/// The servers of the participant's page and of the experimenter's page, in a thread of their own.
/// The session's thread waits for the messages that the servers receive.
class PageDesk::Pages {
 public:
  explicit Pages(const PageOptions& options)
      : participant_view_(
            [this](web::Client& client, std::string_view frame) {
              Take(client, participant_view_, &PageState::FromParticipant, frame);
            },
            [this] {
              const std::lock_guard lock(mutex_);
              return state_.ForParticipant();
            }),
        experimenter_view_(
            [this](web::Client& client, std::string_view frame) {
              Take(client, experimenter_view_, &PageState::FromExperimenter, frame);
            },
            [this] {
              const std::lock_guard lock(mutex_);
              return state_.ForExperimenter();
            }),
        participant_(Listen(context_,
                            {{AddressOf(options), options.participant_port}, "--participant-port"},
                            participant_files_, participant_view_)),
        experimenter_(Listen(
            context_, {{AddressOf(options), options.experimenter_port}, "--experimenter-port"},
            experimenter_files_, experimenter_view_)),
        traffic_(options.traffic),
        run_page_(ForRuns(options)) {
    // In each run, fogline-web listens at this address and port. They are checked now, so that an
    // error comes before the participant begins.
    const Place seat{{AddressOf(options), options.seat_port}, "--seat-port"};
    runtime::tcpq::RequireFree(seat.endpoint, seat.OptionText());
    Publish();
    thread_ = std::thread([this] { context_.run(); });
  }

  ~Pages() {
    // On a busy machine the servers' thread may be late. It must send the last state to the pages
    // before it stops the servers. So this destructor waits until the servers have stopped.
    std::promise<void> stopped;
    asio::post(context_, [&] {
      participant_->Stop();
      experimenter_->Stop();
      stopped.set_value();
    });
    stopped.get_future().wait();
    // The context stops by itself when the last connection is closed, because it then has no more
    // work.
    const TimePoint end = Clock::now() + kEndLimit;
    while (!context_.stopped() && Clock::now() < end) std::this_thread::sleep_for(milliseconds(5));
    context_.stop();
    thread_.join();
  }

  /// Changes the state, and shows it in the participant's page and in the experimenter's page.
  template <class Change>
  void Set(const Change& change) {
    {
      const std::lock_guard lock(mutex_);
      change(state_);
      messages_.clear();
    }
    Publish();
  }

  /// Waits for the next message of this kind. @throws Interrupted
  PageMessage WaitFor(PageMessage::Kind kind) {
    std::unique_lock lock(mutex_);
    for (;;) {
      while (!messages_.empty()) {
        PageMessage message = std::move(messages_.front());
        messages_.pop_front();
        if (message.kind == kind) return message;
      }
      ThrowIfInterrupted();
      changed_.wait_for(lock, kWakeEvery);
    }
  }

  /// Waits until this time. @throws Interrupted
  void WaitUntil(TimePoint end) {
    while (Clock::now() < end) {
      ThrowIfInterrupted();
      std::this_thread::sleep_for(std::min<Duration>(kWakeEvery, end - Clock::now()));
    }
  }

  /// Begins the run. The speaker accepts markers until EndRun().
  void BeginRun(Speaker& speaker) {
    Set([&](PageState& state) {
      speaker_ = &speaker;
      state.Drive();
      state.Tell("the run begins");
    });
  }

  std::string participant_address() const { return participant_->access().Url(); }
  std::string experimenter_address() const { return experimenter_->access().Url(); }

  /// Shows the run in the participant's page and in the experimenter's page.
  /// @throws as RunPage::Show()
  void ShowRun(std::int64_t run_id, const std::string& url, RunPage::Seat seat) {
    run_page_.Show(run_id, url, seat);
    Set([&](PageState& state) {
      state.OpenRun(run_page_.view_address(), run_page_.seat_address());
      if (seat == RunPage::Seat::kOpen) state.Tell("the seat is open");
    });
  }

  /// Waits until the participant is ready at the seat.
  /// @throws Interrupted; std::runtime_error if the seat cannot open again
  void WaitForPerson(std::int64_t run_id, const std::string& url) {
    const bool ready = processes::WaitForPerson(run_id, url, traffic_, [this] {
      LookAtRunPage();
      if (const std::string why = run_page_.WhyHopeless(); !why.empty()) {
        throw std::runtime_error(why);
      }
    });
    if (!ready) ThrowIfInterrupted();
  }

  void LookAtRunPage() {
    const RunPage::Change change = run_page_.Look();
    if (change == RunPage::Change::kNone) return;
    const bool is_back = change == RunPage::Change::kIsBack;
    Set([&](PageState& state) {
      state.MoveRun(run_page_.view_address(), is_back ? run_page_.seat_address() : "");
      state.Tell(is_back ? "fogline-web runs again" : "fogline-web has died and is started again");
    });
  }

  void EndRun() {
    // The participant's page must know that the run has ended, before the seat sends the
    // participant back to this page.
    Set([this](PageState& state) {
      speaker_ = nullptr;
      state.EndRun();
      state.Tell("the run has ended");
    });
    run_page_.End();
  }

 private:
  using Reader = std::optional<PageMessage> (PageState::*)(std::string_view, std::string&) const;

  void Publish() {
    asio::post(context_, [this] {
      participant_view_.Show();
      experimenter_view_.Show();
    });
  }

  /// Handles a frame, in the thread of the servers.
  void Take(web::Client& client, const PageView& view, Reader reader, std::string_view frame) {
    std::string why;
    {
      const std::lock_guard lock(mutex_);
      const auto message = (state_.*reader)(frame, why);
      if (message && message->kind == PageMessage::Kind::kMarker) {
        speaker_->Mark(message->text);
        state_.Tell("marker: " + message->text);
      } else if (message) {
        messages_.push_back(*message);
      }
    }
    if (!why.empty()) return view.Refuse(client, why);
    changed_.notify_all();
    Publish();
  }

  const std::vector<web::Asset> participant_files_ = FilesOf("/index.html", "/participant.js");
  const std::vector<web::Asset> experimenter_files_ =
      FilesOf("/experimenter.html", "/experimenter.js");
  std::mutex mutex_;
  std::condition_variable changed_;
  PageState state_{UnixMicros()};
  std::deque<PageMessage> messages_;  // messages that fit the state, and wait for WaitFor()
  Speaker* speaker_ = nullptr;        // set while markers are accepted
  asio::io_context context_{1};
  PageView participant_view_;
  PageView experimenter_view_;
  std::unique_ptr<web::Server> participant_;
  std::unique_ptr<web::Server> experimenter_;
  const runtime::TrafficOptions traffic_;
  RunPage run_page_;
  std::thread thread_;
};

PageDesk::PageDesk(const PageOptions& options) : pages_(std::make_unique<Pages>(options)) {}
PageDesk::~PageDesk() = default;

std::string PageDesk::participant_address() const { return pages_->participant_address(); }
std::string PageDesk::experimenter_address() const { return pages_->experimenter_address(); }

void PageDesk::WaitForBegin(const Next& next) {
  seat_ = next.seat;
  const TimePoint end =
      Clock::now() + duration_cast<Duration>(std::chrono::duration<double>(next.not_before_s));
  if (Clock::now() < end) {
    pages_->Set([&](PageState& state) { state.Wait(next, Seconds(end - Clock::now())); });
    pages_->WaitUntil(end);
  }
  pages_->Set([&](PageState& state) { state.Wait(next, 0); });
  pages_->WaitFor(PageMessage::Kind::kBegin);
}

void PageDesk::RunOpens(std::int64_t run_id, const std::string& url) {
  pages_->ShowRun(run_id, url, seat_ ? RunPage::Seat::kOpen : RunPage::Seat::kNone);
  if (seat_) pages_->WaitForPerson(run_id, url);
}

void PageDesk::RunBegins(Speaker& speaker) { pages_->BeginRun(speaker); }

void PageDesk::RunGoesOn() { pages_->LookAtRunPage(); }

void PageDesk::RunEnded() { pages_->EndRun(); }

std::vector<Answer> PageDesk::Ask(const Next& after, const QuestionnaireSection& questionnaire) {
  pages_->Set([&](PageState& state) { state.Ask(after, questionnaire); });
  std::vector<Answer> answers = pages_->WaitFor(PageMessage::Kind::kAnswers).answers;
  pages_->Set(
      [&](PageState& state) { state.Tell(fmt::format("{} is answered", questionnaire.name)); });
  return answers;
}

void PageDesk::Finish() {
  pages_->Set([](PageState& state) { state.Finish(); });
}

}  // namespace fogline::trials
