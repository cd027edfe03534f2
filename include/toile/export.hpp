// toile/export.hpp: TOILE_EXPORT stands before every class and function that a shared libtoile shows; everything else is hidden.
// TOILE_HIDDEN: what is inside such a class and for the library alone.
#pragma once

#if defined(__GNUC__)
#define TOILE_EXPORT __attribute__((visibility("default")))
#define TOILE_HIDDEN __attribute__((visibility("hidden")))
#else
#define TOILE_EXPORT
#define TOILE_HIDDEN
#endif
