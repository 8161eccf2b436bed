#include "tools/export/matio_library.h"

#include <dlfcn.h>

#include <stdexcept>

#include <fmt/core.h>

namespace fogline::exports {

const Matio& Matio::Get() {
  static const Matio matio;
  return matio;
}

// The library stays loaded until the process ends.
Matio::Matio() : library_(dlopen(FOGLINE_MATIO, RTLD_NOW | RTLD_LOCAL)) {
  Find("Mat_CreateVer", create);
  Find("Mat_Open", open);
  Find("Mat_Close", close);
  Find("Mat_VarCreate", create_variable);
  Find("Mat_VarCreateStruct2", create_struct);
  Find("Mat_VarSetStructFieldByName", set_field);
  Find("Mat_VarGetStructFieldByName", get_field);
  Find("Mat_VarRead", read);
  Find("Mat_VarWrite", write);
  Find("Mat_VarFree", free);
}

template <class Function>
void Matio::Find(const char* name, Function& function) const {
  void* found = library_ == nullptr ? nullptr : dlsym(library_, name);
  if (found == nullptr) {
    throw std::runtime_error(fmt::format(
        "a MAT-file needs " FOGLINE_MATIO ": install Debian's libmatio ({})", dlerror()));
  }
  function = reinterpret_cast<Function>(found);
}

}  // namespace fogline::exports
