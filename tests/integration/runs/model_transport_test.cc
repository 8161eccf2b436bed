// With each choice of a model for sensors, fusion or cars, a run has the same digest on all
// transports. `fogline check` names impossible choices.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/runs/transports.h"

namespace fogline::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

struct Variant {
  std::string name;
  std::vector<std::string> fields;
};

/// The host has an ACC that can hardly brake, and approaches a slow car. Another car follows the
/// host closely.
const std::vector<std::string> kSlowCar{"/lead/speed_mps=8",
                                        "/world/host_gap_m=40",
                                        "/world/follower_gap_m=10",
                                        "/world/end_on_collision=false",
                                        "/acc/min_acceleration_mps2=-0.1",
                                        "/aeb/enabled=true",
                                        "/followers/aeb/enabled=true"};

std::vector<std::string> With(std::vector<std::string> fields,
                              const std::vector<std::string>& more) {
  fields.insert(fields.end(), more.begin(), more.end());
  return fields;
}

const std::vector<Variant> kVariants{
    {"NoiseByInnovation", {"/fusion/adaptive_noise=innovation"}},
    {"NoiseByResidual", {"/fusion/adaptive_noise=residual", "/fusion/noise_forgetting=0.9"}},
    {"NoiseWithGateAndWitness",
     {"/fusion/adaptive_noise=residual", "/fusion/gating=true", "/arbitrator/measure=witness_nis",
      "/arbitrator/policy=availability"}},
    {"GateThatNeverReopens", {"/fusion/gating=true", "/fusion/gate_reopen_after=0"}},
    {"MissingEchoes", {"/fog/model=modes"}},
    {"MixtureOfModes",
     {"/fog/model=modes", "/fog/modes/biased_share=0.2", "/fog/modes/near_echo_share=0.3",
      "/fog/modes/missing_share=0.4", "/fog/bias_m=3"}},
    {"EmergencyBraking", kSlowCar},
    {"EmergencyBrakingOfVehiclesInFog",
     With(kSlowCar,
          {"/host_vehicle/model=longitudinal", "/follower_vehicle/model=longitudinal",
           "/followers/driver=human", "/human/loses_awareness=true", "/aeb/trigger=either"})},
    {"SetSpeed", {"/acc/max_speed_mps=21", "/arbitrator/policy=none"}},
    {"RecordedLeaderOnIce",
     {"/host_vehicle/model=longitudinal", "/road/surface=ice", "/lead/profile=recorded",
      R"(/lead/recorded/speeds_mps=[20,20,18,16,14,14,14])"}},
};

class ModelTransportTest : public testing::TestWithParam<Variant> {
 protected:
  nlohmann::json Run(const std::string& transport, const std::vector<std::string>& fields) const {
    return RunOn(transport, "scenario/dense_fog.json", folder_.File(transport + ".lcm"),
                 With({"/steps=60", "/fog/start_s=1", "/fog/duration_s=4"}, fields));
  }

  ScratchFolder folder_;
};

TEST_P(ModelTransportTest, HasTheSameDigestInOneProcessInMemoryAndOverTheNetwork) {
  const auto direct = ExpectTheSameOnAnyTransport(
      [this](const std::string& transport) { return Run(transport, GetParam().fields); }, 60);
  EXPECT_NE(direct["digest"], Run("direct", {})["digest"]) << "it makes a difference";
}

INSTANTIATE_TEST_SUITE_P(With, ModelTransportTest, testing::ValuesIn(kVariants),
                         [](const auto& variant) { return variant.param.name; });

TEST(EmergencyBrakingTest, IsToldByTheLogAlone) {
  const ScratchFolder folder;
  const std::string log = folder.File("aeb.lcm");
  RunOn("direct", "scenario/dense_fog.json", log,
        With({"/steps=120", "/fog/model=none"}, kSlowCar));
  const Outcome outcome = RunCommand({Program("fogline"), "events", log, "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::vector<std::string> events;
  const nlohmann::json said = nlohmann::json::parse(outcome.out);
  for (const auto& event : said.at(0).at("events")) {
    events.push_back(event.at("event"));
  }
  EXPECT_THAT(events, Contains("collision warning begins"));
  EXPECT_THAT(events, Contains("emergency braking begins"));
  EXPECT_THAT(events, Contains("emergency braking ends"));
}

TEST(ImpossibleModelTest, IsRefusedBeforeTheRunWithFieldValueAndLimit) {
  const auto refused = [](const std::vector<std::string>& fields, const std::string& why) {
    for (const char* verb : {"check", "run"}) {
      std::vector<std::string> command{Program("fogline"), verb, "scenario/dense_fog.json"};
      if (std::string(verb) == "run") command.insert(command.end(), {"--transport", "udpm"});
      for (const std::string& field : fields) command.insert(command.end(), {"--set", field});
      const Outcome outcome = RunCommand(command);
      EXPECT_EQ(outcome.code, 2) << verb;
      EXPECT_THAT(outcome.err, HasSubstr("scenario/dense_fog.json: error: " + why + "\n")) << verb;
    }
  };
  refused({"/fog/model=modes", "/fog/modes/near_echo_share=0.2"},
          "/fog/modes: biased_share 0, near_echo_share 0.2 and missing_share 1 add up to 1.2; the "
          "sum must be at most 1");
  refused(
      {"/lead/profile=emergency_brake", "/host_vehicle/model=longitudinal", "/road/surface=ice"},
      "/lead/emergency_brake/deceleration_mps2: 6 m/s2; no tyre on this road brakes harder than "
      "1.471 m/s2 (/road/surface is \"ice\", friction 0.15)");
}

}  // namespace
}  // namespace fogline::test
