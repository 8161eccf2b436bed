#include "tools/web/types/lcm_tokens.h"

#include <algorithm>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"

namespace fogline::web {
namespace {

constexpr std::string_view kBlanks = " \t\r\f\v";
constexpr std::string_view kSymbols = "{}[];,=";

bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
// Whether a character belongs to a word. A word may have dots: the name of a struct with its
// package.
bool IsInWord(char c) { return IsLetter(c) || IsDigit(c) || c == '.'; }
// Whether a character belongs to a number. A number may contain the sign of its exponent, and the
// letters of a hexadecimal number.
bool IsInNumber(char c) { return IsInWord(c) || c == '+' || c == '-'; }

std::string_view Trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return "";
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

void AppendLine(std::string_view line, std::string& text) {
  line = Trimmed(line);
  if (line.empty()) return;
  if (!text.empty()) text += ' ';
  text += line;
}

class Lexer {
 public:
  Lexer(std::string_view text, std::string_view file) : rest_(text), file_(file) {}

  std::vector<LcmToken> All() {
    while (SkipBlanks(), !rest_.empty()) {
      if (rest_.starts_with("//")) {
        LineComment();
      } else if (rest_.starts_with("/*")) {
        BlockComment();
      } else {
        Token();
      }
    }
    Add(LcmToken::Kind::kEnd, 0);
    return std::move(tokens_);
  }

 private:
  void SkipBlanks() {
    while (!rest_.empty()) {
      if (rest_.front() == '\n') {
        ++line_;
      } else if (kBlanks.find(rest_.front()) == std::string_view::npos) {
        return;
      }
      rest_.remove_prefix(1);
    }
  }

  void LineComment() {
    std::string_view comment = rest_.substr(0, rest_.find('\n'));
    rest_.remove_prefix(comment.size());
    comment.remove_prefix(std::min(comment.find_first_not_of('/'), comment.size()));
    std::string text;
    AppendLine(comment, text);
    Comment(text, line_);
  }

  void BlockComment() {
    const std::size_t end = rest_.find("*/", 2);
    if (end == std::string_view::npos) Fail("the comment has no end");
    std::string_view comment = rest_.substr(2, end - 2);
    rest_.remove_prefix(end + 2);
    const int began = line_;
    std::string text;
    while (true) {
      const std::size_t length = std::min(comment.find('\n'), comment.size());
      std::string_view line = Trimmed(comment.substr(0, length));
      line.remove_prefix(std::min(line.find_first_not_of('*'), line.size()));
      AppendLine(line, text);
      if (length == comment.size()) break;
      comment.remove_prefix(length + 1);
      ++line_;
    }
    Comment(text, began);
  }

  /// @param began the line on which the comment begins; the comment ends on line_
  void Comment(std::string_view text, int began) {
    if (!tokens_.empty() && tokens_.back().line == began) {
      return AppendLine(text, tokens_.back().comment_behind);
    }
    if (began > comment_end_ + 1) comment_.clear();
    AppendLine(text, comment_);
    comment_end_ = line_;
  }

  void Token() {
    const char first = rest_.front();
    const auto length = [this](bool (*is_in)(char)) {
      return static_cast<std::size_t>(std::ranges::find_if_not(rest_, is_in) - rest_.begin());
    };
    if (IsLetter(first)) return Add(LcmToken::Kind::kWord, length(IsInWord));
    if (IsDigit(first) || first == '-' || first == '+' || first == '.') {
      return Add(LcmToken::Kind::kNumber, length(IsInNumber));
    }
    if (kSymbols.find(first) != std::string_view::npos) return Add(LcmToken::Kind::kSymbol, 1);
    Fail(fmt::format("{} has no meaning here", Quote(std::string(1, first))));
  }

  void Add(LcmToken::Kind kind, std::size_t length) {
    LcmToken token{.kind = kind,
                   .text = std::string(rest_.substr(0, length)),
                   .line = line_,
                   .comment_before = "",
                   .comment_behind = ""};
    if (line_ <= comment_end_ + 1) token.comment_before = std::move(comment_);
    comment_.clear();
    tokens_.push_back(std::move(token));
    rest_.remove_prefix(length);
  }

  [[noreturn]] void Fail(std::string_view what) const {
    throw InputError(fmt::format("{}:{}: error: {}", file_, line_, what));
  }

  std::string_view rest_;
  std::string_view file_;
  int line_ = 1;
  std::string comment_;   // lines of comment directly before the next token
  int comment_end_ = -1;  // the last line of comment_
  std::vector<LcmToken> tokens_;
};

}  // namespace

std::vector<LcmToken> LcmTokens(std::string_view text, std::string_view file) {
  return Lexer(text, file).All();
}

}  // namespace fogline::web
