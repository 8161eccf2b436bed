// Reads LCM's type language as lcm-gen does (LCM, lcmgen.c). Two things that lcm-gen accepts are
// refused: enums, which no generated class for C++ has; and structs without members, because an
// array of them could have any length in a message without bytes.
#pragma once

#include <string_view>
#include <vector>

#include "tools/web/types/lcm_struct.h"

namespace fogline::web {

/// The structs of one file, in their order. Their members name other structs, which LcmTypes finds.
/// @param file for errors
/// @throws InputError "FILE:LINE: error: ..." at the first mistake
std::vector<LcmStruct> ParseLcm(std::string_view text, std::string_view file);

}  // namespace fogline::web
