#include "tools/doctor/doctor_findings.h"

namespace fogline::doctor {

std::string_view NameOf(Finding::Level level) {
  switch (level) {
    case Finding::Level::kOk:
      return "ok";
    case Finding::Level::kWarning:
      return "warning";
    case Finding::Level::kProblem:
      return "problem";
  }
  return "?";
}

}  // namespace fogline::doctor
