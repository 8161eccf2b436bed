// Opens an address in the browser of the person at this machine.
#pragma once

#include <string>

namespace fogline::web {

/// Whether this machine has a screen (DISPLAY or WAYLAND_DISPLAY), and xdg-open, which starts the
/// browser.
bool HasBrowser();

/// Starts the browser, which runs on after the end of this process. A failure is not reported,
/// because the address is printed in any case.
void OpenBrowser(const std::string& url);

}  // namespace fogline::web
