// The files of the pages of fogline-web, built into the program (embed.cmake writes them).
#pragma once

#include <span>
#include <string_view>

namespace fogline::web {

/// A file of a page. A browser requests it by its path.
struct Asset {
  std::string_view path;   // such as "/index.html" or "/page.js"
  std::string_view type;   // the media type, such as "text/html; charset=utf-8"
  std::string_view etag;   // a hash of the bytes, in double quotes as HTTP requires
  std::string_view bytes;  // the content of the file
};

/// The files of all pages; empty if the pages could not be built, because packages of npm were
/// missing.
std::span<const Asset> Assets();

}  // namespace fogline::web
