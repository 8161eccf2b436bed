#include "tools/hosts/ssh_connection.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "common/process/shell_word.h"

namespace fogline::hosts {
namespace {

constexpr Duration kLookEvery = milliseconds(10);
// Time for which the destructor waits until ssh ends.
constexpr Duration kFarewell = milliseconds(500);

// ssh(1): "exits with the exit status of the remote command or with 255 if an error occurred".
constexpr int kSshFailed = 255;
// Exit code of a POSIX shell that does not find the program.
constexpr int kNoProgram = 127;

// The name ($0) of the shell that starts ssh. The shell puts this name before its own errors, so
// HowItEnded() can distinguish them from errors of ssh.
constexpr std::string_view kShell = "--ssh";

/// The options of ssh. With these options ssh never asks for a password, and gives up soon if the
/// machine does not answer.
const std::vector<std::string> kOptions{"-T", "-o", "BatchMode=yes", "-o", "ConnectTimeout=5",
                                        "--"};

/// The command line of `fogline host` on the other machine.
std::string Command(const HostPlan& host) {
  if (host.programs.empty()) return "exec fogline host";
  // ssh starts commands in the home folder, so a folder within the home folder can have a relative
  // path.
  std::string folder = host.programs;
  if (folder.starts_with("~/")) folder = "./" + folder.substr(2);
  return fmt::format("exec {} host", ShellWord(folder + "/fogline"));
}

/// The remedy for an error of ssh, recognized by OpenSSH's words; "" if no remedy is known.
std::string RemedyFor(const std::vector<std::string>& lines, const HostPlan& host) {
  const auto said = [&lines](std::string_view words) {
    return std::ranges::any_of(
        lines, [words](const std::string& line) { return line.find(words) != std::string::npos; });
  };
  const std::string destination = ShellWord(host.destination);
  if (said("Permission denied")) {
    return fmt::format("; it must let this user in with a key: ssh-copy-id {}", destination);
  }
  if (said("Host key verification failed")) {
    return fmt::format("; make its host key known: ssh {} true", destination);
  }
  return "";
}

}  // namespace

SshConnection::SshConnection(const HostPlan& host, const std::string& ssh)
    : host_(host), ssh_(ssh) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::runtime_error(fmt::format("cannot make a socket: {}", std::strerror(errno)));
  }
  socket_ = ends[0];
  fcntl(errors_.read, F_SETFL, O_NONBLOCK);
  std::vector<std::string> arguments{"-c", "exec " + ssh + " \"$@\"", std::string(kShell)};
  arguments.insert(arguments.end(), kOptions.begin(), kOptions.end());
  arguments.insert(arguments.end(), {host.destination, Command(host)});
  try {
    pid_ = processes::StartChild("/bin/sh", arguments, ends[1], errors_.write, ends[1]);
  } catch (...) {
    close(ends[0]);
    close(ends[1]);
    throw;
  }
  close(ends[1]);
  close(std::exchange(errors_.write, -1));
  lines_.emplace(socket_, socket_);
}

SshConnection::~SshConnection() {
  End(kFarewell);
  close(socket_);
}

void SshConnection::Look() {
  // This number of reads empties a full pipe (see pipe(7)).
  constexpr int kReads = 16;
  int status = 0;
  const bool ends = pid_ >= 0 && waitpid(pid_, &status, WNOHANG) == pid_;
  std::array<char, 4096> buffer{};
  for (int i = 0; i < kReads; ++i) {
    const ssize_t size = read(errors_.read, buffer.data(), buffer.size());
    if (size <= 0) break;
    printed_.Append({buffer.data(), static_cast<std::size_t>(size)});
  }
  if (!ends) return;
  pid_ = -1;
  status_ = status;
}

std::string SshConnection::HowItEnded(const std::vector<std::string>& lines) const {
  const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
  if (code == kSshFailed) {
    return fmt::format("ssh {} failed{}", ShellWord(host_.destination), RemedyFor(lines, host_));
  }
  const auto is_local = [](const std::string& line) {
    return line.starts_with(fmt::format("{}: ", kShell));
  };
  if (std::ranges::any_of(lines, is_local)) {
    return fmt::format("the command {} cannot be run on this machine{}", ShellWord(ssh_),
                       ssh_ == "ssh" ? " (apt-get install openssh-client)" : "");
  }
  if (code != kNoProgram) return fmt::format("fogline host {}", processes::HowItEnded(status_));
  if (!host_.programs.empty()) return fmt::format("there is no {}/fogline", host_.programs);
  return "there is no fogline in the PATH there; name its folder: --on ROLE=HOST:/FOLDER, or "
         "\"programs\" in the file of --lab";
}

void SshConnection::End(Duration limit) {
  shutdown(socket_, SHUT_WR);
  for (const TimePoint end = Clock::now() + limit; pid_ >= 0; Look()) {
    if (Clock::now() >= end) kill(pid_, SIGKILL);
    std::this_thread::sleep_for(kLookEvery);
  }
}

}  // namespace fogline::hosts
