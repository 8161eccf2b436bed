#include "services/runtime/process/run_id_option.h"

#include <limits>

#include <CLI/CLI.hpp>

#include "common/parse_number.h"

namespace fogline::runtime {

void AddRunIdOption(CLI::App& app, const std::string& name, std::optional<std::int64_t>& run_id,
                    const std::string& help) {
  app.add_option(name, run_id, help)
      ->check(CLI::Range(std::int64_t{1}, std::numeric_limits<std::int64_t>::max()))
      ->check([](const std::string& text) {  // CLI11 takes the nearest number that fits
        return ParseNumber<std::int64_t>(text)
                   ? std::string()
                   : text + " is no id: a whole number from 1 to 9223372036854775807";
      })
      ->type_name("ID");
}

}  // namespace fogline::runtime
