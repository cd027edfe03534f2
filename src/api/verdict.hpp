// api/verdict.hpp: converts the judge's report into the library's types.
#pragma once
#include "toile/verify.hpp"
#include "verify/verdict.hpp"

namespace toile {

Verdict verdict_of(const internal::VerifyReport& audit, const internal::Verdict& judged);

}  // namespace toile
