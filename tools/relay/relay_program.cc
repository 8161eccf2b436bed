#include "tools/relay/relay_program.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include <fmt/core.h>
#include <boost/asio/signal_set.hpp>

#include "common/errors.h"
#include "common/exit_code.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "services/runtime/process/program_options.h"
#include "services/runtime/transport/tcpq_url.h"
#include "tools/relay/relay.h"

namespace fogline::relay {
namespace {

namespace asio = boost::asio;

constexpr const char* kFooter =
    R"(Prints its URL on stdout. Prints on stderr which clients it disconnects and why,
and a summary at the end. Ctrl-C, SIGTERM or SIGHUP ends it. Any program may
connect: listen on 127.0.0.1 or on a network that you trust.

Exit codes: 0 stopped, 2 bad usage, an address of another machine, or a port that it
cannot have, 3 any other error.

Examples:
  fogline-relay                              on this machine, port 7700
  fogline-relay --listen 192.168.1.5:7700    for other machines
  fogline run scenario/paper.json --transport tcpq://192.168.1.5:7700
  lcm-logger --lcm-url=tcpq://192.168.1.5:7700 run.lcm    (LCM's own programs
                                             need the address in numbers))";

constexpr std::size_t kMebibyte = 1 << 20;

/// Options of the command line.
struct Arguments {
  std::string listen = "127.0.0.1:7700";
  std::size_t message_mib = 4;
  std::size_t queue_mib = 16;
  RelayOptions relay;
  bool quiet = false;

  void AddTo(runtime::ProgramOptions& options) {
    options.Text("--listen", listen, "ADDRESS:PORT; port 0: any free port",
                 runtime::ProgramOptions::Help::kWithDefault);
    options.Count("--max-message", message_mib, "Largest message, in MiB", 1, 256);
    options.Count("--max-queue", queue_mib,
                  "Disconnect a client for which more than this waits, in MiB", 1, 4096);
    options.Count("--max-clients", relay.clients, "Most clients at a time", 1, 10'000);
    options.Count("--max-subscriptions", relay.subscriptions, "Most subscriptions of one client", 1,
                  100'000);
    options.Flag("--quiet", quiet, "Print no summary at the end");
    options.Footer(kFooter);
  }
};

int RunRelay(const Arguments& arguments) {
  RelayOptions options = arguments.relay;
  options.limits.payload = arguments.message_mib * kMebibyte;
  options.queue_bytes = arguments.queue_mib * kMebibyte;
  const runtime::tcpq::Endpoint listen = runtime::tcpq::ResolveOwn(arguments.listen, "--listen");
  asio::io_context context(1);
  std::unique_ptr<Relay> relay;
  try {
    relay = std::make_unique<Relay>(
        context, asio::ip::tcp::endpoint(asio::ip::make_address(listen.address), listen.port),
        options);
  } catch (const boost::system::system_error& error) {
    runtime::tcpq::ThrowCannotListen(listen, "--listen", error.code());
  }
  asio::signal_set signals(context);
  for (const int signal : EndingSignals()) signals.add(signal);
  signals.async_wait([&relay](boost::system::error_code, int) { relay->Stop(); });
  const runtime::tcpq::Endpoint here{listen.address, relay->endpoint().port()};
  fmt::print("{}\n", here.Url());
  if (std::fflush(stdout) != 0) {
    throw std::runtime_error(fmt::format("cannot write the URL: {}", std::strerror(errno)));
  }
  context.run();
  if (!arguments.quiet) Complain(fmt::format("fogline-relay: {}", relay->Summary()));
  return kDone;
}

}  // namespace

int RunProgram(int argc, char** argv) {
  TakeStandardDescriptors();
  runtime::ProgramOptions options(
      "fogline-relay", "Carries LCM messages over TCP (tcpq://) where multicast is blocked.",
      FOGLINE_VERSION);
  Arguments arguments;
  arguments.AddTo(options);
  if (const std::optional<int> exit_code = options.Parse(argc, argv)) return *exit_code;
  try {
    return RunRelay(arguments);
  } catch (const InputError& error) {
    Complain(fmt::format("fogline-relay: {}", error.what()));
    return kBadInput;
  } catch (const std::exception& error) {
    Complain(fmt::format("fogline-relay: error: {}", error.what()));
    return kRunFailed;
  }
}

}  // namespace fogline::relay
