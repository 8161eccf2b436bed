// The errors that a program reports to its user.
#pragma once

#include <stdexcept>

namespace fogline {

/// Bad input of a user. A program prints what() and exits with code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace fogline
