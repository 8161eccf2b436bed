// The requests of a page to the server of `fogline view`. Input: a text frame.
#include <nlohmann/json.hpp>

#include "tests/fuzz/fuzz.h"
#include "tools/web/view_messages.h"
#include "tools/web/view_request.h"

namespace fogline::fuzz {
namespace {

void DemandRange(std::int64_t from, std::int64_t to) {
  Demand(from >= 0 && to >= from && to <= 1'000'000'000, "a request names steps that may exist");
}

void DemandSafe(const web::BadRequest& bad) {
  Demand(!bad.why.empty(), "a refusal has a reason");
  const std::string text = web::ErrorText(bad.id, bad.why);
  Demand(nlohmann::json::accept(text), "a refusal is valid JSON");
  Demand(text.size() < 1000, "a refusal is short");
}

void DemandSafe(const web::StepsRequest& steps) {
  DemandRange(steps.from, steps.to);
  Demand(steps.to - steps.from < web::StepsRequest::kMostSteps, "an answer has a bound");
  Took();
}

void DemandSafe(const web::SeriesRequest& series) {
  DemandRange(series.from, series.to);
  Demand(series.points >= 1 && series.points <= web::SeriesRequest::kMostPoints,
         "an answer has a bound");
  Took();
}

void DemandSafe(const web::HistoryRequest&) { Took(); }

}  // namespace

std::vector<Input> Seeds() {
  std::vector<Input> seeds;
  for (const std::string_view text :
       {R"({"op":"steps","id":7,"from":100,"to":163})",
        R"({"op":"series","id":8,"channel":"TRUTH","field":"follower_gap_m[0]","from":0,"to":499,)"
        R"("points":1000})",
        R"({"op":"history","id":4294967295})", R"({"op":"steps","id":-1})"}) {
    seeds.emplace_back(text.begin(), text.end());
  }
  return seeds;
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // The server refuses larger frames.
  if (size > std::size_t{64} << 10) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::visit([](const auto& request) { fogline::fuzz::DemandSafe(request); },
             fogline::web::ParseViewRequest(text));
  return 0;
}
