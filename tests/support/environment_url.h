// Sets and unsets LCM_DEFAULT_URL for a test of code that reads this variable.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace fogline::test {

/// Unsets LCM_DEFAULT_URL, which the user's shell may have set. The destructor restores it.
class EnvironmentUrl {
 public:
  EnvironmentUrl() {
    if (const char* url = std::getenv(kName)) before_ = url;
    Unset();
  }
  ~EnvironmentUrl() {
    if (before_) Set(*before_);
    if (!before_) Unset();
  }
  EnvironmentUrl(const EnvironmentUrl&) = delete;
  EnvironmentUrl& operator=(const EnvironmentUrl&) = delete;

  void Set(const std::string& url) const { setenv(kName, url.c_str(), 1); }
  void Unset() const { unsetenv(kName); }

 private:
  static constexpr const char* kName = "LCM_DEFAULT_URL";
  std::optional<std::string> before_;
};

}  // namespace fogline::test
