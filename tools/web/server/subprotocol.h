// The subprotocols of the WebSockets.
#pragma once

#include <string>
#include <string_view>

namespace fogline::web {

/// The subprotocols of WebSockets: our own for viewers and for the client that drives, and both
/// names of Foxglove's protocol.
inline constexpr std::string_view kViewProtocol = "fogline.view.v1";
inline constexpr std::string_view kDriveProtocol = "fogline.drive.v1";
inline constexpr std::string_view kFoxgloveProtocol = "foxglove.websocket.v1";
inline constexpr std::string_view kFoxgloveSdkProtocol = "foxglove.sdk.v1";

constexpr bool IsFoxglove(std::string_view protocol) {
  return protocol == kFoxgloveProtocol || protocol == kFoxgloveSdkProtocol;
}

/// The first subprotocol in the header Sec-WebSocket-Protocol that the server knows. The header may
/// name several subprotocols.
/// @param seat whether a person may drive
/// @return kViewProtocol if the header is empty; "" if the server knows none of them
std::string_view ChooseProtocol(std::string_view header, bool seat);

/// A line for clients that names the subprotocols of the server.
std::string SubprotocolsText(bool seat);

}  // namespace fogline::web
