// Shows a recorded run to the clients of a server. Clients request the data that they show.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "tools/web/log/log_index.h"
#include "tools/web/server/server.h"
#include "tools/web/view_request.h"

namespace fogline::web {

class LogView final : public View {
 public:
  /// @param run_id the run to show; nullopt: the first run in the log
  /// @throws InputError if the log cannot be shown
  LogView(std::filesystem::path file, std::optional<std::int64_t> run_id)
      : file_(std::move(file)), index_(file_, run_id) {}

  const LogIndex& index() const { return index_; }

  void Opened(Client& client) override;
  void Received(Client& client, std::string_view bytes, bool binary) override;
  void Idle(Client&) override {}
  void Closed(Client&) override {}

 private:
  OutgoingFrame Answer(const ViewRequest& request) const;

  std::filesystem::path file_;
  LogIndex index_;
};

}  // namespace fogline::web
