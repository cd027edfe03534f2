// apps/cli/process_end.hpp: the end of the program on a signal, or when memory is refused.                  docs/command-line.md
//
//   SIGINT, SIGTERM, SIGHUP, SIGXCPU   interrupted() is true from then on.  A phase that polls it ends in order; one that does not is left
//                                      after 0.8 s, without cleanup
//   a second SIGINT or SIGTERM         exits at once
//   memory refused                     std::bad_alloc, as usual; if that does not end the program (a thread that others wait for), it exits after 2 s
//   SIGPIPE, SIGXFSZ                   ignored: the write fails with an error that says why
//
// Always by an exit code (8, 7), never by a signal.  No data are lost: files get their names when they are complete, and frames are written
// to the disk as they come.
#pragma once
namespace toile::internal {

// Call once, at the start of main.  `json`: an exit without other output prints an object on stdout, too.
void prepare_for_the_end(bool json);

// Has a signal asked for an end?  Polled by phases that then end soon: from the first true on they have 2 s in place of the 0.8 s.
bool interrupted();

}  // namespace toile::internal
