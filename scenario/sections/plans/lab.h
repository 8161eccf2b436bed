// The fields of a laboratory: the machines on which the roles of a run are started by ssh.
// tools/hosts/lab_file.h reads and checks the JSON files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenario/sections/field.h"

namespace fogline {

/// A machine, and the roles that run on it.
struct LabHostSection {
  FOGLINE_FIELD(std::string, name, "", "Name of the machine in messages, and after --on ROLE=.");
  FOGLINE_FIELD(std::string, ssh, "",
                "Where ssh connects to: [USER@]HOST, or a name of ssh's configuration. Empty: the "
                "name.");
  FOGLINE_FIELD(std::string, programs, "",
                "Folder of Fogline's programs there; a relative folder is relative to the home "
                "folder. Empty: the PATH there.");
  FOGLINE_FIELD(std::vector<std::string>, roles, {}, {0, 31},
                "Roles that run there: any but the recorder.");  // graph.h allows 31 roles
};

/// A laboratory, as its file describes it.
struct LabPlan {
  FOGLINE_FIELD(std::int64_t, version, 1, {1, 1}, "Version of the file format.",
                "the only version so far");
  FOGLINE_FIELD(std::string, description, "", "What this laboratory is.");
  FOGLINE_FIELD(std::vector<LabHostSection>, hosts, {}, {1, 64}, "The machines.");
  FOGLINE_FIELD(std::string, url, "",
                "LCM URL of the network. Empty: a multicast port of the run's own, with ttl=1.");
  FOGLINE_FIELD(std::string, key, "",
                "File of the key that signs messages; a relative name is relative to the folder of "
                "this file. Empty: no key. The machines get the key from the run.");
  FOGLINE_FIELD(std::string, ssh, "",
                "Command that is used in place of ssh, with its options. Empty: $FOGLINE_SSH, or "
                "ssh.");
  FOGLINE_FIELD(bool, relay, false,
                "Whether messages go through a relay on the machine of the run, because the "
                "network carries no multicast.");
  FOGLINE_FIELD(std::string, relay_at, "",
                "ADDRESS[:PORT] at which the relay listens. Empty: the address at which the "
                "machines see the machine of the run.");
};

}  // namespace fogline
