// toile/export.hpp: TOILE_EXPORT marks every class and function that a shared libtoile exports; everything else is hidden.
// TOILE_HIDDEN: a nested class of an exported one that only the library uses.
#pragma once

#if defined(__GNUC__)
#define TOILE_EXPORT __attribute__((visibility("default")))
#define TOILE_HIDDEN __attribute__((visibility("hidden")))
#else
#define TOILE_EXPORT
#define TOILE_HIDDEN
#endif
