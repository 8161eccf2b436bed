// These tests check which folder may use which other folder, how many files a folder may have, and
// that each name has only one meaning. A room is a folder with its subfolders; a subfolder may be a
// room of its own. The rooms have an order: the files of a room may use only this room and the
// rooms before it.
#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

struct Room {
  std::string folder;  // with the subfolders that are not rooms of their own; see kAlone
  std::string space;   // the namespace of its types is fogline::SPACE; "": fogline
  std::string why;     // reason for the position of this room in the order
  bool of_role = false;
};

/// This name stands for every folder services/NAME that has NAME_main.cc, except services/recorder.
constexpr const char* kRoleFolder = "services/NAME";

/// Replaces the room kRoleFolder by one room for the folder of each role.
std::vector<Room> WithRoles(std::vector<Room> rooms) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(SourceDirectory() / "services")) {
    const std::string name = entry.path().filename();
    if (std::filesystem::exists(entry.path() / (name + "_main.cc"))) names.insert(name);
  }
  names.erase("recorder");
  auto place = rooms.erase(std::ranges::find(rooms, kRoleFolder, &Room::folder));
  for (const std::string& name : names) {
    place = rooms.insert(place, {"services/" + name, name, "a role", true}) + 1;
  }
  return rooms;
}

/// A file may include files of its own room and of rooms before it, and a library may link
/// libraries of rooms before it. But a role may use no other role, with one exception
/// (kRoleOfRole). NAME_main.cc is a program, so it may include files of all rooms.
const std::vector<Room> kRooms = WithRoles({
    {"common", "", "knows nothing of Fogline"},
    {"common/process", "", "this process: its console, what it waits for, what it takes"},
    {"fogline", "", "the message types that lcm-gen makes of lcmtypes/"},
    {"scenario/sections", "", "what an experiment can choose"},
    {"scenario/io", "", "reads, checks and explains the sections"},
    {"services", "", "graph.h and what all roles share: who sends what to whom"},
    {"services/models/vehicle", "models", "a car"},
    {"services/models/driver", "models", "a person who drives"},
    {"services/models/follower", "models", "a following car; a person may drive it"},
    {"services/models/minimal_risk", "models", "how a car stops, and who drives it"},
    {"services/models/aeb", "models", "how a car brakes in an emergency, by what its driver sees"},
    {"services/decision/conflict", "conflict", "what a measure of conflict is"},
    {"services/decision/conflict/one_step", "conflict", "measures of the readings of a step"},
    {"services/decision/conflict/over_time", "conflict", "measures that may use those of a step"},
    {"services/decision/policies", "policies", "who should drive, from models and conflict"},
    {"services/decision/take_over", "take_over", "the request to a person, and its end"},
    {"services/models/traffic", "models", "cars that another simulator moves"},
    {"services/models/sumo", "sumo", "this simulator, as a module that is loaded on demand"},
    {kRoleFolder, "", "the folders of roles, which use no other role; see kRoleOfRole"},
    {"services/runtime/wire", "runtime", "the bytes of messages"},
    {"services/metrics", "metrics", "judges what the messages of a run say"},
    {"services/closed_loop", "closed_loop", "all roles in one process, and their metrics"},
    {"services/runtime/transport", "runtime", "carries the bytes"},
    {"services/runtime/discovery", "runtime", "finds runs by what is carried"},
    {"services/runtime/node", "runtime", "a role's part in any run"},
    {"services/runtime/lockstep", "runtime", "a role's part in a run that waits"},
    {"services/runtime/realtime", "runtime", "a role's part in a run that does not wait"},
    {"services/runtime/seat", "runtime", "what a person does, for a role's part in such a run"},
    {"services/runtime/coordination", "runtime", "the runner's part in both"},
    {"services/runtime/process", "runtime", "makes a process of a role"},
    {"services/log", "log", "the file that a run leaves"},
    {"services/recorder", "recorder", "the role that writes it"},
    {"tools/asio", "", "Boost.Asio, compiled once; has no header of its own"},
    {"tools/stats", "stats", "numbers about many runs"},
    {"tools/compare", "compare", "a run beside recorded driving"},
    {"tools/sweep", "sweep", "many runs"},
    {"tools/report", "report", "pages about them"},
    {"tools/export", "exports", "logs for other programs"},
    {"tools/watch", "watch", "what is on a network"},
    {"tools/record", "record", "writes what is on a network into a log"},
    {"tools/web/types", "web", "what the bytes of a message mean, for the page"},
    {"tools/export/mcap", "mcap", "the same logs as MCAP, by what the bytes of a message mean"},
    {"tools/web/foxglove", "web", "the same messages for viewers of other projects"},
    {"tools/relay", "relay", "carries messages over TCP"},
    {"tools/processes", "processes", "starts and watches processes"},
    {"tools/hosts", "hosts", "the same on other machines"},
    {"tools/replay", "replay", "computes a role again from a log"},
    {"tools/runner", "runner", "makes one run, over any transport"},
    {"tools/drive", "drive", "a seat: what a person does, as messages"},
    {"tools/spy", "spy", "LCM's viewer with Fogline's types"},
    {"tools/doctor", "doctor", "examines the machine, and these tools on it"},
    {"tools/cli", "cli", "what the command lines of verbs share"},
    {"tools/calibrate", "calibrate", "a program"},
    {"tools/study", "study", "a program"},
    {"tools/web/server", "web", "HTTP and WebSockets; knows no runs"},
    {"tools/web", "web", "a program: the page of a run or a log"},
    {"tools/web/seat", "web", "one person at the page drives; the only client that is heard"},
    {"tools/trials", "trials", "experiments with people: trials, questions, tables"},
    {"tools/fogline", "", "the verbs"},
    {"tools/python", "python", "a module for Python: a class there as a role"},
    {"tools/benchmarks", "benchmarks", "a program that measures the others"},
});

/// The room "services" has only the files directly in this folder. So a new subfolder of it needs a
/// line of its own in kRooms.
constexpr std::string_view kAlone = "services";

/// The only role that uses another role: a following car may have the host's ACC.
constexpr std::array<std::string_view, 2> kRoleOfRole{"services/follower", "services/acc"};

bool IsOtherRole(const Room& room, const Room& included) {
  return room.of_role && included.of_role && room.folder != included.folder &&
         (room.folder != kRoleOfRole[0] || included.folder != kRoleOfRole[1]);
}

/// The table of all measures of conflict. This file may include all measures; no measure includes
/// the header of this table.
constexpr std::string_view kTableOfMeasures = "services/decision/conflict/conflict_measures.cc";

/// The room of a file; nullopt if the file is in no room.
std::optional<std::size_t> RoomOf(const std::filesystem::path& file) {
  for (auto folder = file.parent_path(); !folder.empty(); folder = folder.parent_path()) {
    const auto room = std::ranges::find(kRooms, folder.generic_string(), &Room::folder);
    if (room == kRooms.end()) continue;
    if (folder == kAlone && file.parent_path() != kAlone) return std::nullopt;
    return room - kRooms.begin();
  }
  return std::nullopt;
}

std::string Read(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The C++ files of these folders, relative to the folder of the sources, in the order of their
/// names.
std::vector<std::filesystem::path> Sources(const std::vector<std::string>& tops = {
                                               "common", "scenario", "services", "tools"}) {
  std::vector<std::filesystem::path> sources;
  for (const std::string& top : tops) {
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(SourceDirectory() / top)) {
      const auto extension = entry.path().extension();
      if (extension != ".h" && extension != ".cc") continue;
      sources.push_back(std::filesystem::relative(entry.path(), SourceDirectory()));
    }
  }
  std::ranges::sort(sources);
  return sources;
}

/// "FILE includes FILE" for each include that the order of the rooms forbids.
std::vector<std::string> ForbiddenIncludes(const std::filesystem::path& file,
                                           const std::string& text) {
  static const std::regex include("(?:^|\n)#include \"([^\"]+)\"");
  const auto room = RoomOf(file);
  if (!room) return {file.string() + " is in no room"};
  if (file.stem().string().ends_with("_main") || file == kTableOfMeasures) return {};
  std::vector<std::string> forbidden;
  for (std::sregex_iterator at(text.begin(), text.end(), include), end; at != end; ++at) {
    const std::string included = (*at)[1];
    const std::size_t place = RoomOf(included).value_or(kRooms.size());
    if (place <= *room && !IsOtherRole(kRooms[*room], kRooms[place])) continue;
    forbidden.push_back(file.string() + " includes " + included);
  }
  return forbidden;
}

TEST(HouseTest, FilesIncludeOnlyWhatStandsBeforeThem) {
  const auto sources = Sources();
  ASSERT_GT(sources.size(), 300U);
  std::vector<std::string> forbidden;
  for (const auto& file : sources) {
    std::ranges::move(ForbiddenIncludes(file, Read(SourceDirectory() / file)),
                      std::back_inserter(forbidden));
  }
  EXPECT_THAT(forbidden, IsEmpty());
}

TEST(HouseTest, FindsAForbiddenInclude) {
  const std::string text =
      "// Radar.\n#include \"services/graph.h\"\n#include \"services/runtime/transport/bus.h\"\n";
  EXPECT_THAT(ForbiddenIncludes("services/radar/radar.h", text),
              ElementsAre("services/radar/radar.h includes services/runtime/transport/bus.h"));
  EXPECT_THAT(ForbiddenIncludes("services/radar/radar_main.cc", text), IsEmpty());
  EXPECT_THAT(ForbiddenIncludes("common/clock.h", "#include \"attic/clock.h\"\n"),
              ElementsAre("common/clock.h includes attic/clock.h"));
  EXPECT_THAT(ForbiddenIncludes("common/text.cc", "#include \"common/process/console.h\"\n"),
              ElementsAre("common/text.cc includes common/process/console.h"));
}

TEST(HouseTest, ARoleUsesNoOtherRoleExceptThatAFollowingCarMayHaveAnAcc) {
  const std::string acc = "#include \"services/acc/acc_controller.h\"\n";
  EXPECT_THAT(ForbiddenIncludes("services/follower/acc_driver.h", acc), IsEmpty());
  EXPECT_THAT(ForbiddenIncludes("services/acc/acc.h", acc), IsEmpty());
  for (const char* file : {"services/driver/driver.h", "services/world/world.h"}) {
    EXPECT_THAT(ForbiddenIncludes(file, acc),
                ElementsAre(std::string(file) + " includes services/acc/acc_controller.h"));
  }
}

TEST(HouseTest, FindsAFileThatIsInNoRoom) {
  for (const char* file :
       {"services/new/new.h", "services/runtime/new.h", "services/models/new.h", "attic/new.h"}) {
    EXPECT_THAT(ForbiddenIncludes(file, ""), ElementsAre(std::string(file) + " is in no room"));
  }
  EXPECT_THAT(ForbiddenIncludes("services/acc/acc.h", "#include \"services/new/new.h\"\n"),
              ElementsAre("services/acc/acc.h includes services/new/new.h"));
  EXPECT_THAT(ForbiddenIncludes("services/graph.h", "#include \"scenario/sections/s.h\"\n"),
              IsEmpty());
}

TEST(HouseTest, OnlyFilesThatAnExtensionReplacesAndAProgramIncludeTheListsOfChoices) {
  // scenario/sections/decision.h has the lists of choices. A program with more policies or measures
  // (tests/integration/extension) replaces the library files that include these lists. If a library
  // had a further file that includes them, the program would have two definitions of a list.
  std::vector<std::string> files;
  for (const auto& file : Sources()) {
    const std::string text = Read(SourceDirectory() / file);
    if (text.find("#include \"scenario/sections/decision.h\"") == std::string::npos) continue;
    files.push_back(file.string());
  }
  EXPECT_THAT(files,
              ElementsAre("scenario/sections/field_view.cc",
                          "services/decision/conflict/conflict_measures.cc",
                          "services/decision/policies/policies.cc", "tools/fogline/report.cc"));
}

/// The positions of a library's folders in the order of the rooms (kRooms). A folder without a room
/// comes after all rooms.
std::set<std::size_t> PlacesOf(const std::string& folders) {
  std::set<std::size_t> places;
  std::istringstream in(folders);
  for (std::string folder; std::getline(in, folder, ',');) {
    places.insert(RoomOf(std::filesystem::path(folder) / "any.cc").value_or(kRooms.size()));
  }
  return places;
}

/// The libraries that each library links, and the positions of each library's folders.
struct Links {
  std::map<std::string, std::vector<std::string>> linked;
  std::map<std::string, std::set<std::size_t>> places{{"fogline_lcmtypes", PlacesOf("fogline")}};
};

/// @param lines one line "LIBRARY FOLDER,FOLDER... LINKED..." for each library, written by
/// fogline_write_links() in cmake/fogline.cmake
Links ReadLinks(const std::string& lines) {
  Links links;
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string library, folders;
    words >> library >> folders;
    links.places[library] = PlacesOf(folders);
    links.linked[library].assign(std::istream_iterator<std::string>(words), {});
  }
  return links;
}

/// "LIBRARY links LIBRARY" for each link that the order of the folders (kRooms) forbids. Every
/// folder of the linked library must come before every folder of the linking library. So allowed
/// links make no cycle.
std::vector<std::string> ForbiddenLinks(const Links& links) {
  std::vector<std::string> forbidden;
  for (const auto& [library, all_linked] : links.linked) {
    for (const std::string& linked : all_linked) {
      const auto place = links.places.find(linked);
      const std::size_t first = *links.places.at(library).begin();
      const bool of_role = place != links.places.end() && first < kRooms.size() &&
                           *place->second.rbegin() < kRooms.size() &&
                           IsOtherRole(kRooms[first], kRooms[*place->second.rbegin()]);
      if (place != links.places.end() && *place->second.rbegin() < first && !of_role) continue;
      forbidden.push_back(library + " links " + linked);
    }
  }
  return forbidden;
}

TEST(HouseTest, LibrariesLinkOnlyWhatStandsBeforeThem) {
  const Links links = ReadLinks(Read(std::filesystem::path(FOGLINE_BINARY_DIR) / "links.txt"));
  EXPECT_GE(links.linked.size(), 30U);
  EXPECT_THAT(links.linked.at("fogline_runtime"),
              UnorderedElementsAre("fogline_common", "fogline_lcmtypes", "fogline_scenario",
                                   "fogline_wire"));
  EXPECT_THAT(ForbiddenLinks(links), IsEmpty());
}

TEST(HouseTest, FindsALinkThatRunsBack) {
  const std::string scenario =
      "fogline_common common,common/process \n"
      "fogline_scenario scenario/io,scenario/sections fogline_common";
  const std::string policies =
      "\nfogline_policies services/decision/policies fogline_lcmtypes fogline_scenario\n";
  EXPECT_THAT(ForbiddenLinks(ReadLinks(scenario + policies)), IsEmpty());
  EXPECT_THAT(ForbiddenLinks(ReadLinks(scenario + " fogline_policies" + policies)),
              ElementsAre("fogline_scenario links fogline_policies"));
  EXPECT_THAT(ForbiddenLinks(ReadLinks("fogline_common common fogline_attic\n")),
              ElementsAre("fogline_common links fogline_attic"));
}

TEST(HouseTest, FindsALinkToALibraryWithOneFolderTooFarBehind) {
  const std::string metrics = "fogline_metrics services/metrics fogline_runtime\n";
  const std::string runtime = "fogline_runtime services/runtime/wire";
  EXPECT_THAT(ForbiddenLinks(ReadLinks(metrics + runtime)), IsEmpty());
  EXPECT_THAT(ForbiddenLinks(ReadLinks(metrics + runtime + ",services/runtime/transport")),
              ElementsAre("fogline_metrics links fogline_runtime"));
}

TEST(HouseTest, FindsALinkOfARoleToAnotherRole) {
  const std::string acc = "fogline_acc services/acc\n";
  EXPECT_THAT(ForbiddenLinks(ReadLinks(acc + "fogline_follower services/follower fogline_acc\n")),
              IsEmpty());
  EXPECT_THAT(ForbiddenLinks(ReadLinks(acc + "fogline_world services/world fogline_acc\n")),
              ElementsAre("fogline_world links fogline_acc"));
}

TEST(HouseTest, NoFolderHasMoreThan20Files) {
  constexpr int kMost = 20;
  std::map<std::filesystem::path, int> files;
  for (const auto& file : Sources()) ++files[file.parent_path()];
  for (const auto& file : Sources({"tests"})) ++files[file.parent_path()];
  for (const auto& [folder, count] : files) EXPECT_LE(count, kMost) << folder;
}

TEST(HouseTest, TestsOfAFolderLieInTheSameFolderAgain) {
  const std::filesystem::path tests = SourceDirectory() / "tests";
  int folders = 0;
  for (const char* kind : {"unit", "property"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(tests / kind)) {
      if (!entry.is_directory()) continue;
      const auto folder = std::filesystem::relative(entry.path(), tests / kind);
      if (folder == "fallback") continue;  // tests of whole runs in which a role stops sending
      EXPECT_TRUE(std::filesystem::is_directory(SourceDirectory() / folder)) << entry.path();
      ++folders;
    }
  }
  EXPECT_GT(folders, 50);
}

/// "NAMESPACE::NAME" of each type that a header defines outside of other types.
std::set<std::string> TypesOf(const std::string& header) {
  static const std::regex line(
      "(?:^|\n)(?:namespace ([a-z_:]+) \\{|"
      "(?:class|struct|enum(?: class)?) (\\w+)[^;<\n]*\\{|using (\\w+) =)");
  std::set<std::string> types;
  std::string space;
  for (std::sregex_iterator at(header.begin(), header.end(), line), end; at != end; ++at) {
    if ((*at)[1].matched) space = (*at)[1];
    for (const int group : {2, 3}) {
      if ((*at)[group].matched) types.insert(space + "::" + (*at)[group].str());
    }
  }
  return types;
}

TEST(HouseTest, NoTwoHeadersDefineATypeOfTheSameName) {
  std::map<std::string, std::filesystem::path> known;
  for (const auto& file : Sources()) {
    if (file.extension() != ".h") continue;
    for (const std::string& type : TypesOf(Read(SourceDirectory() / file))) {
      const auto [first, fresh] = known.emplace(type, file);
      EXPECT_TRUE(fresh) << type << " is defined in " << first->second << " and in " << file;
    }
  }
  EXPECT_GT(known.size(), 300U);
}

TEST(HouseTest, TypesLieInTheNamespaceOfTheirFolder) {
  for (const auto& file : Sources()) {
    const auto room = RoomOf(file);
    if (file.extension() != ".h" || !room) continue;
    const std::string& space = kRooms[*room].space;
    const std::string begin = "fogline::" + space + (space.empty() ? "" : "::");
    for (const std::string& type : TypesOf(Read(SourceDirectory() / file))) {
      if (type.starts_with("internal::")) continue;  // nested in the namespace of its file
      EXPECT_THAT(type, StartsWith(begin)) << file;
      if (space.empty()) {
        EXPECT_EQ(type.rfind("::"), begin.size() - 2) << type << " in " << file;
      }
    }
  }
}

TEST(HouseTest, FindsTheTypesOfAHeader) {
  EXPECT_THAT(
      TypesOf("namespace fogline::report {\n\nstruct Window {\n  enum class Kind { kA };\n};\n"
              "class Later;\nclass Curve final : public Line {\n};\n"
              "enum Side : int { kLeft };\nusing Curves = std::vector<Curve>;\n"),
      ElementsAre("fogline::report::Curve", "fogline::report::Curves", "fogline::report::Side",
                  "fogline::report::Window"));
}

}  // namespace
}  // namespace fogline::test
