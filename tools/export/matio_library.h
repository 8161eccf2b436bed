// The functions of matio. matio is loaded only when it is first used, because it needs 30 other
// libraries (HDF5, and the libraries that HDF5 needs). Loading these libraries takes more time than
// most verbs need.
#pragma once

#include <matio.h>

#include <memory>

namespace fogline::exports {

class Matio {
 public:
  /// @throws std::runtime_error if matio is missing
  static const Matio& Get();

  struct Free {
    void operator()(matvar_t* variable) const { Get().free(variable); }
    void operator()(mat_t* file) const { Get().close(file); }
  };
  using Variable = std::unique_ptr<matvar_t, Free>;
  using File = std::unique_ptr<mat_t, Free>;

  decltype(&Mat_CreateVer) create;
  decltype(&Mat_Open) open;
  decltype(&Mat_Close) close;
  decltype(&Mat_VarCreate) create_variable;
  decltype(&Mat_VarCreateStruct2) create_struct;
  decltype(&Mat_VarSetStructFieldByName) set_field;
  decltype(&Mat_VarGetStructFieldByName) get_field;
  decltype(&Mat_VarRead) read;
  decltype(&Mat_VarWrite) write;
  decltype(&Mat_VarFree) free;

 private:
  Matio();

  template <class Function>
  void Find(const char* name, Function& function) const;

  void* library_;
};

}  // namespace fogline::exports
