// Whether this build has the pages of fogline-web.
#pragma once

#include <string_view>

namespace fogline::web {

/// Why this build has no page for a browser, and what to do; "" if it has one. A program that only
/// starts fogline-web asks this, because Assets() would put all files of the pages into it.
std::string_view WhyNoPage();

}  // namespace fogline::web
