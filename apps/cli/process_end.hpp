// apps/cli/process_end.hpp: how the program ends when it must: asked to by a signal, or refused memory.     docs/command-line.md
//
//   SIGINT, SIGTERM, SIGHUP, SIGXCPU   interrupted() is true from then on.  Who asks it ends in its own good order; a phase that does not
//                                      ask is left after 0.8 s, without anything that runs on the way out
//   a second SIGINT or SIGTERM         leaves at once
//   memory refused                     std::bad_alloc, as ever; what it cannot end (a thread that others wait for) is left after 2 s
//   SIGPIPE, SIGXFSZ                   ignored: what is written there fails, as an error with its reason
//
// Always by an exit code (8, 7), never by a signal.  Leaving loses nothing: files get their names when they are complete, and frames are on
// the disk as they come.
#pragma once
namespace toile::internal {

// Once, at the start of main.  `json`: whoever is left without another word gets an object on stdout, too.
void prepare_for_the_end(bool json);

// Has somebody asked for an end?  Asked by a phase that will end soon: from the first true on it has 5 s in place of the 0.8 s.
bool interrupted();

}  // namespace toile::internal
