// fogline: the main program for users. Every verb has a file of its own.
#include "tools/cli/own_program.h"
#include "tools/cli/verb_program.h"
#include "tools/fogline/verbs.h"

int main(int argc, char** argv) {
  using namespace fogline;
  cli::BecomeOwnProgram(argc, argv);
  return cli::RunVerbs(
      argc, argv,
      {AddRun,    AddDrive,  AddTable,  AddSweep,  cli::AddOwnPrograms, AddMetrics, AddCompare,
       AddReport, AddDigest, AddDiff,   AddEvents, AddReplay,           AddExport,  AddGraph,
       AddCheck,  AddTop,    AddRecord, AddSpy,    AddLogplayer,        AddDoctor,  AddHost,
       AddKeygen, AddHelp});
}
