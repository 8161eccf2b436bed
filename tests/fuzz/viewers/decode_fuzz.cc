// The decoder of messages for the page of `fogline view`: whole messages as JSON, and single
// fields. Input: an index into kChannels, and the message. The index kNumChannels means a type with
// features that Fogline's types do not have; then the target puts the fingerprint of this type
// before the input.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "tests/fuzz/samples.h"
#include "tests/support/numeric_fields.h"
#include "tools/web/types/decode.h"
#include "tools/web/types/description.h"
#include "tools/web/types/field_reader.h"
#include "tools/web/types/fields.h"
#include "tools/web/types/lcm_parser.h"

namespace fogline::fuzz {
namespace {

using Json = nlohmann::ordered_json;

const web::LcmTypes& OtherTypes() {
  static const web::LcmTypes types(web::ParseLcm(
      "struct part_t { byte b; boolean ok; string s; int8_t n; float f[n]; }"
      "struct all_t { int16_t rows; int8_t cols; int16_t grid[rows][cols]; part_t parts[rows];"
      "  part_t one; string names[cols]; int64_t cube[2][2][2]; float last; }",
      "other"));
  return types;
}

/// A type, and a reader for each of its numbers.
struct Reading {
  explicit Reading(const web::LcmTypes& all, const web::LcmStruct& of) : types(all), type(of) {
    const test::NumericFields numbers(types, type);
    for (const std::string& path : numbers.paths()) {
      paths.push_back(web::ParsePath(path));
      readers.emplace_back(types, type, path);
    }
  }
  const web::LcmTypes& types;
  const web::LcmStruct& type;
  std::vector<std::vector<web::PathPart>> paths;
  std::vector<web::FieldReader> readers;
};

/// The number at a path; nullopt if the JSON has no number at this path.
std::optional<double> NumberAt(const Json& message, const std::vector<web::PathPart>& path) {
  const Json* value = &message;
  for (const web::PathPart& part : path) {
    value = &value->at(part.name);
    for (const std::size_t index : part.indices) {
      if (index >= value->size()) return std::nullopt;
      value = &value->at(index);
    }
  }
  if (value->is_null()) return std::nullopt;
  if (value->is_boolean()) return value->get<bool>() ? 1 : 0;
  return value->is_string() ? static_cast<double>(std::stoll(value->get<std::string>()))
                            : value->get<double>();
}

/// Whether the number of a reader equals the number in the JSON. JSON shows a boolean as true or
/// false, so any number except 0 equals true.
bool Agree(const std::optional<double>& read, const std::optional<double>& shown,
           const Reading& reading, const std::vector<web::PathPart>& path) {
  const web::LcmStruct* type = &reading.type;
  const web::LcmMember* member = nullptr;
  for (const web::PathPart& part : path) {
    member = &*std::ranges::find(type->members, part.name, &web::LcmMember::name);
    if (!member->primitive) type = &reading.types.StructOf(*member);
  }
  if (member->primitive == web::LcmPrimitive::kBoolean && read && shown) {
    return (*read != 0) == (*shown != 0);
  }
  return read == shown;
}

void DemandReadable(const Reading& reading, runtime::Bytes bytes, const std::optional<Json>& json) {
  for (std::size_t i = 0; i < reading.readers.size(); ++i) {
    const std::optional<double> value = reading.readers[i](bytes);
    Demand(!value || std::isfinite(*value), "a field is finite or has no value");
    const std::optional<double> cut = reading.readers[i](bytes.first(bytes.size() / 2));
    Demand(!cut || cut == value, "a message without its end has the same fields, or less");
    if (!json) continue;
    Demand(Agree(value, NumberAt(*json, reading.paths[i]), reading, reading.paths[i]),
           "a field has the value that the whole message has there");
  }
}

/// All numbers and texts in a JSON value, from front to back.
void Flatten(const Json& value, std::vector<Json>& flat) {
  if (!value.is_structured()) return flat.push_back(value);
  for (const Json& part : value) Flatten(part, flat);
}

template <class V>
void Append(const V& value, std::vector<Json>& flat) {
  if constexpr (std::is_same_v<V, header_t>) {
    for (const std::int64_t number : {value.run_id, value.step, value.utime}) {
      flat.push_back(web::IntegerJson(number));
    }
  } else if constexpr (std::is_same_v<V, std::string>) {
    flat.emplace_back(value);
  } else if constexpr (std::is_same_v<V, double>) {
    flat.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
  } else if constexpr (std::is_integral_v<V>) {
    flat.push_back(web::IntegerJson(value));
  } else {
    for (const auto& element : value) Append(element, flat);
  }
}

bool Equal(const Json& shown, const Json& expected) {
  if (shown.is_boolean()) return shown.get<bool>() == (expected.get<std::int64_t>() != 0);
  // The decoder has replaced the bytes of the text that are not valid UTF-8 by U+FFFD.
  if (shown.is_string() && expected.is_string() && shown != expected) {
    return shown.get<std::string>().find("\xef\xbf\xbd") != std::string::npos;
  }
  return shown == expected;
}

/// Whether a value obeys its JSON schema, or is one of the exceptions that
/// tools/web/types/description.h names.
bool Fits(const Json& value, const Json& schema) {
  const std::string type = schema.at("type");
  if (type == "object") {
    const Json& properties = schema.at("properties");
    if (!value.is_object() || value.size() != properties.size()) return false;
    for (const auto& [name, property] : properties.items()) {
      if (!value.contains(name) || !Fits(value.at(name), property)) return false;
    }
    return true;
  }
  if (type == "array") {
    return value.is_array() && std::ranges::all_of(value, [&schema](const Json& element) {
             return Fits(element, schema.at("items"));
           });
  }
  if (type == "integer") return value.is_number_integer() || value.is_string();
  if (type == "number") return value.is_number_float() || value.is_null();
  return type == "boolean" ? value.is_boolean() : value.is_string();
}

template <class M>
void DemandAsGenerated(runtime::Bytes bytes) {
  static const Reading reading(web::FoglineTypes(), *web::FoglineTypes().Named(M::getTypeName()));
  const std::optional<Json> json = web::DecodeJson(reading.types, reading.type, bytes);
  M message{};
  Demand(json.has_value() == runtime::Decode(bytes, message),
         "the page decodes what the generated class decodes");
  DemandReadable(reading, bytes, json);
  if (!json) return;
  std::vector<Json> shown;
  std::vector<Json> expected;
  Flatten(*json, shown);
  VisitFields(message, [&](std::string_view, const auto& value) { Append(value, expected); });
  Demand(std::ranges::equal(shown, expected, Equal), "both find the same values");
  Demand(nlohmann::json::accept(json->dump()), "the JSON text is valid JSON");
  static const Json schema = web::SchemaJson(reading.types, reading.type);
  Demand(Fits(*json, schema), "the message is what the schema says");
  Took();
}

void DemandBounded(runtime::Bytes rest) {
  static const Reading reading(OtherTypes(), *OtherTypes().Named("all_t"));
  Input bytes;
  for (int shift = 56; shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<std::uint8_t>(reading.type.fingerprint >> shift));
  }
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  const std::optional<Json> json = web::DecodeJson(reading.types, reading.type, bytes);
  DemandReadable(reading, bytes, json);
  if (!json) return;
  // A byte of the message becomes at most a few characters of the text, and each element of `parts`
  // adds the names of its fields. Together this is less than 64 characters for each byte.
  Demand(json->dump().size() <= 1000 + 64 * bytes.size(), "no message becomes a long text");
  Took();
}

}  // namespace

std::vector<Input> Seeds() {
  std::vector<Input> seeds = SeedOfEachType();
  Input other{static_cast<std::uint8_t>(kNumChannels), 0, 1, 2, 0, 1, 0, 2};  // rows, cols, grid
  for (int part = 0; part < 2; ++part) {
    other.insert(other.end(), {7, 1, 0, 0, 0, 2, 'a', 0, 1, 0x3f, 0x80, 0, 0});
  }
  for (int name = 0; name < 2; ++name) other.insert(other.end(), {0, 0, 0, 2, 'n', 0});
  other.resize(other.size() + 8 * 8 + 4);  // fields cube and last
  seeds.push_back(other);
  return seeds;
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t channel = data[0] % (fogline::kNumChannels + 1);
  const fogline::runtime::Bytes bytes(data + 1, size - 1);
  if (channel == fogline::kNumChannels) {
    fogline::fuzz::DemandBounded(bytes);
  } else {
    fogline::fuzz::ForEachType([&]<class M>(std::size_t place) {
      if (place == channel) fogline::fuzz::DemandAsGenerated<M>(bytes);
    });
  }
  return 0;
}
