// Opens an address in the browser of the person at this machine.
#pragma once

#include <string>

namespace fogline::web {

/// Whether there is a screen (DISPLAY or WAYLAND_DISPLAY), and xdg-open, which knows the browser.
bool HasBrowser();

/// Starts the browser. It outlives this process. A browser that cannot be started is not reported:
/// the address is printed anyway.
void OpenBrowser(const std::string& url);

}  // namespace fogline::web
