// fogline: the main program for users. Every verb is in a file of its own.
#include "tools/fogline/own_program.h"
#include "tools/fogline/verb_main.h"
#include "tools/fogline/verbs.h"

int main(int argc, char** argv) {
  using namespace fogline;
  BecomeOwnProgram(argc, argv);
  return RunVerbs(argc, argv,
                  {AddRun, AddTable, AddSweep, AddOwnPrograms, AddMetrics, AddCompare, AddReport,
                   AddDigest, AddDiff, AddEvents, AddReplay, AddExport, AddGraph, AddCheck, AddTop,
                   AddSpy, AddDoctor, AddKeygen, AddHelp});
}
