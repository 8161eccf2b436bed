// The errors that bad input gets, in tests.
#pragma once

#include <string>

#include "common/errors.h"

namespace fogline::test {

/// The text of the InputError that a call throws; "" if it throws none.
template <class Call>
std::string ErrorOf(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace fogline::test
