// The text of an error that a call throws, for tests.
#pragma once

#include <string>

#include "common/errors.h"

namespace fogline::test {

/// The text of the InputError, or of another Error, that a call throws; "" if it throws none.
template <class Error = InputError, class Call>
std::string ErrorOf(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace fogline::test
