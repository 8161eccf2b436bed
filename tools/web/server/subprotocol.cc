#include "tools/web/server/subprotocol.h"

#include <fmt/core.h>
#include <boost/beast/http/rfc7230.hpp>

namespace fogline::web {

std::string_view ChooseProtocol(std::string_view header, bool seat) {
  if (header.empty()) return kViewProtocol;
  namespace beast = boost::beast;
  for (const auto& token :
       beast::http::token_list(beast::string_view(header.data(), header.size()))) {
    const std::string_view name(token.data(), token.size());
    for (const std::string_view known : {kViewProtocol, kFoxgloveProtocol, kFoxgloveSdkProtocol}) {
      if (name == known) return known;
    }
    if (seat && name == kDriveProtocol) return kDriveProtocol;
  }
  return "";
}

std::string SubprotocolsText(bool seat) {
  return fmt::format("The subprotocols here are {}{}{}, {} and {}.\n", kViewProtocol,
                     seat ? ", " : "", seat ? kDriveProtocol : "", kFoxgloveProtocol,
                     kFoxgloveSdkProtocol);
}

}  // namespace fogline::web
