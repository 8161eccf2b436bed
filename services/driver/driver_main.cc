// The process of the human driver: answers TRUTH with DRIVER_COMMAND. The driver offers an
// acceleration in every step, also while the automation drives.
#include "services/driver/driver.h"
#include "services/runtime/process/service.h"

int main(int argc, char** argv) {
  return fogline::runtime::RunService<fogline::driver::Driver>(argc, argv);
}
