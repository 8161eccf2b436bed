// The program of the verb `fogline view`. It shows the run on the network, or a log, in a browser.
// Without --seat it never sends a message to a run.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>

#include "common/errors.h"
#include "common/exit_code.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/text.h"
#include "services/runtime/process/program_options.h"
#include "services/runtime/transport/tcpq_url.h"
#include "services/runtime/transport/traffic_options.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/own_program.h"
#include "tools/cli/verb_program.h"
#include "tools/web/browser.h"
#include "tools/web/live_view.h"
#include "tools/web/log/log_view.h"
#include "tools/web/seat/seat_view.h"
#include "tools/web/server/page.h"
#include "tools/web/server/server.h"

namespace fogline::web {
namespace {

namespace asio = boost::asio;

constexpr std::uint16_t kDefaultPort = 7680;
// Number of ports that are tried, beginning with the default port, if the user has chosen no port.
constexpr std::uint16_t kPortsTried = 20;
// Time after Ctrl-C in which all connections must be closed.
constexpr std::chrono::milliseconds kEndLimit(600);

constexpr const char* kExplanation =
    R"(Without LOG it shows the run that is on the network: that of --lcm-url, or else the
newest run that is announced on this machine. With LOG it shows a recorded run, also one
that was cut off. It prints the address of the page, and opens it in a browser if there
is a screen. Ctrl-C ends it. Any number of people may look, up to 64 connections at a
time. A viewer cannot change a run: the program sends no message to it.

With --seat one person can drive, at the page /drive (docs/drive.md). The program then prints
two addresses: first the one of this page, then the one for those who look. It sends what the
person does to the run, and nothing else.

Only this machine can see the page, unless --listen names an address for others. The
printed address then has a token. A person with the address can see everything; the
traffic is not encrypted, so listen only on a network that you trust, or use ssh -L.

The WebSocket at /ws is for other programs, too: docs/view.md describes its protocol.
Foxglove and Lichtblick can connect to it (live runs only).

Examples:
  fogline run scenario/paper.json --pace 1 & fogline view
  fogline view logs/paper-1.lcm
  fogline view logs/paper-1.lcm --open-at 190
  fogline view --listen 192.168.1.5                    for other machines
  ssh -L 7680:127.0.0.1:7680 lab1 fogline view         the run on lab1, seen here
  fogline view --allow-origin http://localhost:8080    for Lichtblick, served there)";

struct ViewArguments {
  explicit ViewArguments(CLI::App& verb) : network(verb, "to show") {
    verb.add_option("LOG", log, "Log to show; without it, the run that is on the network");
    verb.add_option("--key", traffic.key_file,
                    fmt::format("Show only messages that are signed with the key in this file "
                                "(default: ${})",
                                runtime::kKeyVariable));
    listen_said = verb.add_option("--listen", listen,
                                  "ADDRESS[:PORT] of this machine at which others may look, too");
    port_said = verb.add_option("--port", port,
                                "Port on this machine; 0: any free port (default: the first free "
                                "one of 7680 to 7699)")
                    ->check(CLI::Range(0, 65535))
                    ->excludes(listen_said);
    verb.add_flag("--tokens-on-stdin", tokens_on_stdin,
                  "For --listen: read the tokens from stdin, so that the addresses stay the same "
                  "after a restart; in the first line that of the viewers, with --seat in the "
                  "second line that of the person who drives")
        ->needs(listen_said);
    verb.add_option("--allow-origin", origins,
                    "Pages of this origin may connect, too, such as http://localhost:8080 "
                    "(repeatable)")
        ->allow_extra_args(false);
    verb.add_flag("--no-browser", no_browser, "Only print the address");
    runtime::AddRunIdOption(verb, "--run", run,
                            "Id of the run to show (default: the first run in the log, or the "
                            "newest run on the network)");
    verb.add_flag("--seat", seat, "One person may drive in the run, at the page /drive");
    verb.add_option("--open-at", open_at, "Step of the log that the page shows first")
        ->check(CLI::Range(0, 1'000'000'000));
    cli::ShowExitCodes(verb, {.done = "ended by Ctrl-C, SIGTERM or SIGHUP"});
    verb.footer(kExplanation);
  }

  cli::NetworkArguments network;
  std::string log;
  runtime::TrafficOptions traffic;
  std::string listen;
  CLI::Option* listen_said = nullptr;
  std::uint16_t port = kDefaultPort;
  CLI::Option* port_said = nullptr;
  bool tokens_on_stdin = false;
  std::vector<std::string> origins;
  bool no_browser = false;
  bool seat = false;
  std::optional<std::int64_t> run;
  std::optional<std::int64_t> open_at;
};

/// @throws InputError for options that contradict each other
void CheckTogether(const ViewArguments& arguments) {
  const bool live = arguments.log.empty();
  if (live && arguments.open_at) {
    throw InputError("error: --open-at: a step of a log; LOG is missing");
  }
  if (!live && !arguments.network.Follows()) {
    throw InputError("error: --lcm-url: a log needs no network; leave out --lcm-url or the log");
  }
  if (!live && !arguments.traffic.key_file.empty()) {
    throw InputError("error: --key: for the messages of a network; see fogline digest LOG --key");
  }
  if (!live && arguments.seat) {
    throw InputError("error: --seat: no person can drive in a log; leave out LOG");
  }
  for (const std::string& origin : arguments.origins) {
    if (IsOrigin(origin)) continue;
    throw InputError(
        fmt::format("error: --allow-origin {}: this is not an origin such as http://localhost:8080",
                    EscapeControls(origin)));
  }
}

/// Reads a token from the next line of stdin. @throws InputError
std::string ReadToken() {
  std::string token;
  std::getline(std::cin, token);
  if (IsToken(token)) return token;
  throw InputError(
      "error: --tokens-on-stdin: a line is no token: 16 to 128 letters, digits, - and _");
}

/// @throws InputError if --listen names no address of this machine, a line of stdin is not a token,
///     or both tokens are equal
ServerOptions OptionsOf(const ViewArguments& arguments) {
  ServerOptions options{
      .port = arguments.port, .origins = arguments.origins, .seat = arguments.seat};
  if (arguments.listen_said->count() == 0) return options;
  const auto endpoint = runtime::tcpq::ResolveOwn(arguments.listen, "--listen");
  options.address = endpoint.address;
  const bool has_port = runtime::tcpq::HasPort(arguments.listen);
  options.port = has_port ? endpoint.port : kDefaultPort;
  const auto next_token = arguments.tokens_on_stdin ? ReadToken : DrawToken;
  options.token = next_token();
  if (arguments.seat) options.driver_token = next_token();
  if (options.token == options.driver_token) {
    throw InputError(
        "error: --tokens-on-stdin: both lines are the same token; the driver's opens no view, and "
        "the viewers' no seat");
  }
  return options;
}

/// Whether the user has chosen the port. Otherwise the program tries the next ports if one is busy.
bool HasChosenPort(const ViewArguments& arguments) {
  return arguments.port_said->count() > 0 || runtime::tcpq::HasPort(arguments.listen);
}

/// @throws as runtime::tcpq::ThrowCannotListen() for a port that the user has chosen; otherwise
///     std::runtime_error if it can listen at none of the ports
std::unique_ptr<Server> Listen(asio::io_context& context, const ViewArguments& arguments,
                               ServerOptions options, View& view) {
  const int tries = HasChosenPort(arguments) ? 1 : kPortsTried;
  for (int tried = 1;; ++tried) {
    try {
      return std::make_unique<Server>(context, options, Assets(), view);
    } catch (const boost::system::system_error& error) {
      const bool busy = error.code() == boost::system::errc::address_in_use;
      if (busy && tried < tries) {
        ++options.port;
        continue;
      }
      if (!HasChosenPort(arguments)) {
        const int first = options.port - tried + 1;
        const std::string ports =
            tried == 1 ? std::to_string(first) : fmt::format("{} to {}", first, options.port);
        throw std::runtime_error(fmt::format("cannot listen on {}:{}: {}", options.address, ports,
                                             error.code().message()));
      }
      const bool by_port = arguments.port_said->count() > 0;
      runtime::tcpq::ThrowCannotListen({options.address, options.port},
                                       by_port ? "--port" : "--listen", error.code());
    }
  }
}

/// Prints the addresses, and opens the first address in a browser.
void Say(const ViewArguments& arguments, const Server& server) {
  const std::string step =
      arguments.open_at ? fmt::format("step={}", *arguments.open_at) : std::string();
  const std::string view = server.access().Url(step);
  const std::string url = arguments.seat ? server.access().DriveUrl() : view;
  fmt::print("{}\n", url);
  if (arguments.seat) fmt::print("{}\n", view);
  std::fflush(stdout);
  // Every user of the machine can read the arguments of the browser's program. So no address with a
  // token is passed to it.
  const bool has_token = url.find("token=") != std::string::npos;
  if (!arguments.no_browser && !has_token && HasBrowser()) OpenBrowser(url);
}

/// Serves a view until a signal ends the program.
/// @param stop_view ends the work of the view
template <class StopView>
void Serve(asio::io_context& context, const ViewArguments& arguments, Server& server,
           const StopView& stop_view) {
  asio::signal_set signals(context);
  for (const int signal : EndingSignals()) signals.add(signal);
  signals.async_wait([&context](boost::system::error_code, int) { context.stop(); });
  Say(arguments, server);
  context.run();
  server.Stop();
  stop_view();
  // Tells the clients that the program ends. run_for() returns when the last connection is closed,
  // and at the latest after kEndLimit.
  context.restart();
  context.run_for(kEndLimit);
}

/// The key of a live view, from --key or from the variable kKeyVariable. This function is not
/// called for a log, because a log needs no key. So the variable may also be set if a log is shown.
/// @throws InputError
std::optional<runtime::SigningKey> KeyOf(const ViewArguments& arguments) {
  return runtime::KeyOf(runtime::WithKeyOfEnvironment(arguments.traffic));
}

/// Checks that this build has a page for a browser. If the page is missing, but the user wants no
/// browser, this function only prints a warning.
/// @throws std::runtime_error if the page is missing and the user wants a browser
void RequirePage(const ViewArguments& arguments) {
  const std::string why(WhyNoPage());
  if (why.empty()) return;
  if (!arguments.no_browser) throw std::runtime_error(why);
  Notice("fogline view: warning: " + why);
}

int RunView(const ViewArguments& arguments) {
  CheckTogether(arguments);
  RequirePage(arguments);
  const ServerOptions options = OptionsOf(arguments);
  asio::io_context context(1);
  if (arguments.log.empty()) {
    const std::optional<runtime::SigningKey> key = KeyOf(arguments);
    LiveView view(context, {.url = arguments.network.Url(),
                            .follows = arguments.network.Follows(),
                            .run = arguments.run,
                            .key = key,
                            .waits_for_person = arguments.seat && arguments.run});
    std::optional<SeatView> seat;
    if (arguments.seat) seat.emplace(context, view, key);
    View& shown = seat ? static_cast<View&>(*seat) : view;
    const auto server = Listen(context, arguments, options, shown);
    view.Show(*server);
    Serve(context, arguments, *server, [&] {
      if (seat) seat->Stop();
      view.Stop();
    });
    return kDone;
  }
  LogView view(arguments.log, arguments.run);
  const LogIndex& index = view.index();
  if (arguments.open_at.value_or(index.last_step()) > index.last_step()) {
    throw InputError(fmt::format("error: --open-at {}: the last step of {} is {}",
                                 *arguments.open_at, PathText(arguments.log), index.last_step()));
  }
  const std::string& note = index.run().note;
  if (!note.empty()) Notice(fmt::format("{}: {}", PathText(arguments.log), note));
  const auto server = Listen(context, arguments, options, view);
  Serve(context, arguments, *server, [] {});
  return kDone;
}

void AddView(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand(cli::kView.verb, cli::kView.purpose);
  const auto arguments = std::make_shared<ViewArguments>(*verb);
  verb->callback([&action, arguments] { action = [arguments] { return RunView(*arguments); }; });
}

}  // namespace
}  // namespace fogline::web

int main(int argc, char** argv) {
  return fogline::cli::RunOneVerb(argc, argv, fogline::web::AddView);
}
