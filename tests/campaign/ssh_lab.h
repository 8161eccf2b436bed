// Simulated machines with OpenSSH's server. Host keys, configurations and the key of the user are
// in a temporary folder. The tests change no file outside of this folder.
#pragma once

#include <gtest/gtest.h>

#include <deque>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/command.h"
#include "tests/support/network.h"

namespace fogline::test {

class SshLab {
 public:
  static constexpr const char* kServer = "/usr/sbin/sshd";

  /// Machines lab1, lab2, ... Each of them except lab1 has a server.
  explicit SshLab(int machines) : lab_(machines) {
    for (const std::string name : {"host_key", "user_key"}) {
      const Outcome made = RunCommand(
          {"ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-C", name, "-f", folder_.File(name)});
      EXPECT_EQ(made.code, 0) << made.err;
    }
    std::filesystem::copy_file(folder_.File("user_key.pub"), folder_.File("authorized_keys"));
    std::ofstream(folder_.File("ssh_config"))
        << "Host lab*\n  User root\n  Port 2222\n  IdentitiesOnly yes\n  IdentityFile '"
        << folder_.File("user_key") << "'\n  UserKnownHostsFile '" << folder_.File("known_hosts")
        << "'\n  GlobalKnownHostsFile none\n  HostKeyAlias lab\n";
    for (int i = 1; i <= machines + 1; ++i) {  // the last name belongs to no machine
      std::ofstream(folder_.File("ssh_config"), std::ios::app)
          << "Host lab" << i << "\n  HostName 10.76.67." << i << "\n";
    }
    std::ofstream(folder_.File("known_hosts")) << "lab " << Content(folder_.File("host_key.pub"));
    for (int i = 1; i < machines; ++i) Serve(lab_[static_cast<std::size_t>(i)], "authorized_keys");
  }

  /// Starts a server on a machine. @param keys name of the file with the keys that may log in
  void Serve(const Machine& machine, const std::string& keys) {
    const std::string config = folder_.File("sshd_config_" + machine.name() + keys);
    std::ofstream(config) << "Port 2222\nHostKey " << folder_.File("host_key")
                          << "\nPidFile none\nUsePAM no\nStrictModes no\nUseDNS no\n"
                          << "PermitRootLogin yes\nPasswordAuthentication yes\nAuthorizedKeysFile "
                          << folder_.File(keys) << "\n";
    // The server needs the folder /run/sshd, so it gets a file system /run of its own.
    servers_.emplace_back(
        machine.On({"unshare", "--mount", "sh", "-ec",
                    "mount -t tmpfs none /run; mkdir -m 755 /run/sshd; exec \"$@\"", "sh", kServer,
                    "-D", "-e", "-f", config}));
    EXPECT_TRUE(servers_.back().WaitForErr("Server listening")) << servers_.back().Err();
  }
  /// Ends all servers, and starts servers that accept no key of the user.
  void ForgetTheUser() {
    servers_.clear();
    for (std::size_t i = 1; i < lab_.machines().size(); ++i) Serve(lab_[i], "none");
  }
  /// Deletes the known host keys.
  void ForgetTheHosts() const { std::ofstream(folder_.File("known_hosts")); }

  const Lab& lab() const { return lab_; }
  const Machine& operator[](std::size_t i) const { return lab_[i]; }
  /// The command in place of ssh: ssh with the configuration of these machines.
  std::string ssh() const { return "ssh -F '" + folder_.File("ssh_config") + "'"; }

 private:
  ScratchFolder folder_;
  Lab lab_;
  std::deque<Background> servers_;
};

}  // namespace fogline::test
