// Reads LCM's type language in the same way as lcm-gen (LCM, lcmgen.c). The parser refuses two
// things that lcm-gen accepts. It refuses enums, because the classes that lcm-gen generates for C++
// have no enums. It refuses structs without members: an array of such structs takes no bytes in a
// message, so the size of the message would not limit the length of the array.
#pragma once

#include <string_view>
#include <vector>

#include "tools/web/types/lcm_struct.h"

namespace fogline::web {

/// The structs of one file, in their order. If a member is a struct, LcmTypes finds this struct
/// later.
/// @param file name of the file for errors
/// @throws InputError "FILE:LINE: error: ..." at the first mistake
std::vector<LcmStruct> ParseLcm(std::string_view text, std::string_view file);

}  // namespace fogline::web
