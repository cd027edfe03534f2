// api/verdict.hpp: what the judge says, in the library's words.
#pragma once
#include "toile/verify.hpp"
#include "verify/verdict.hpp"

namespace toile {

Verdict verdict_of(const internal::VerifyReport& audit, const internal::Verdict& judged);

}  // namespace toile
