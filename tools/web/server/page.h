// Whether this build has the pages of fogline-web.
#pragma once

#include <string_view>

namespace fogline::web {

/// The reason why this build has no page for a browser, and a remedy; "" if it has a page. A
/// program that only starts fogline-web calls this function instead of Assets(), because Assets()
/// would add all files of the pages to the program.
std::string_view WhyNoPage();

}  // namespace fogline::web
