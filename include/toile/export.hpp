// toile/export.hpp: TOILE_EXPORT stands before every class and function that a shared libtoile shows; everything else is hidden.
#pragma once

#if defined(__GNUC__)
#define TOILE_EXPORT __attribute__((visibility("default")))
#else
#define TOILE_EXPORT
#endif
