// The process of the human driver (TRUTH to DRIVER_COMMAND). It offers an acceleration in every
// step, also while the automation drives.
#include "services/driver/driver.h"
#include "services/runtime/process/service.h"

int main(int argc, char** argv) {
  return fogline::runtime::RunService<fogline::driver::Driver>(argc, argv);
}
