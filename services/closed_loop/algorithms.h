// The algorithms of all roles, made from the rows of graph.h and the folders of services. Every
// program that needs all algorithms includes this file. The compiler reports a row without a
// folder, and a folder without a row.
#pragma once

#include <algorithm>
#include <string_view>
#include <tuple>

#include "services/algorithm.h"
#include "services/graph.h"

namespace fogline {
#define FOGLINE_DECLARE_ROLE(folder, Class, purpose) \
  namespace folder {                                 \
  class Class;                                       \
  }
FOGLINE_ROLES(FOGLINE_DECLARE_ROLE)
#undef FOGLINE_DECLARE_ROLE
}  // namespace fogline

// services/CMakeLists.txt makes the next header. It includes the headers of all folders
// services/NAME that have NAME_main.cc, and defines kRoleFolders, the names of these folders.
#include "services/role_folders.h"

namespace fogline::closed_loop {

template <class First, class... A>
struct WithoutFirst {
  using Type = std::tuple<A...>;
};

#define FOGLINE_ROLE_CLASS(folder, Class, purpose) , folder::Class
/// The algorithms of all roles that compute messages, in the order of evaluation within a step.
using Algorithms = typename WithoutFirst<void FOGLINE_ROLES(FOGLINE_ROLE_CLASS)>::Type;
#undef FOGLINE_ROLE_CLASS

/// Whether a class is defined, and not only declared.
template <class A>
concept Defined = requires {
  sizeof(A);
};

#define FOGLINE_CHECK_ROLE(folder, Class, purpose)                                                 \
  static_assert(Defined<folder::Class>, "the role " #folder " of graph.h needs services/" #folder  \
                                        "/" #folder "_main.cc, and the class " #folder "::" #Class \
                                        " in services/" #folder "/" #folder ".h");                 \
  static_assert(AlgorithmTraits<folder::Class>::kRole == Role::k##Class,                           \
                "graph.h gives the messages that " #folder "::" #Class                             \
                "::Step returns to another role");
FOGLINE_ROLES(FOGLINE_CHECK_ROLE)
#undef FOGLINE_CHECK_ROLE

static_assert(std::ranges::all_of(kRoleFolders,
                                  [](std::string_view folder) {
                                    return std::ranges::find(kRoles, folder, &RoleInfo::name) !=
                                           kRoles.end();
                                  }),
              "a folder services/NAME with NAME_main.cc has no row in FOGLINE_ROLES of graph.h");

}  // namespace fogline::closed_loop
