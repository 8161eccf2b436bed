#include "tools/web/server/page.h"

namespace fogline::web {

std::string_view WhyNoPage() {
  if (FOGLINE_HAS_PAGE) return "";
  return "this build has no page, because packages of npm were missing when it was configured; "
         "install and build: tools/setup run && tools/build fogline_demo";
}

}  // namespace fogline::web
