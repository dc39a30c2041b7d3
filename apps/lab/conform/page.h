// The result of `burnish conform`: page, JSON, JUnit, and the error's line.
#pragma once
#include <string>

#include "apps/lab/conform/draw.h"
#include "apps/lab/conform/judge.h"
#include "apps/lab/conform/pictures.h"
#include "core/base/result.h"

namespace burnish {

const char* outcome_name(SceneJudgement::Outcome outcome); // "right", "wrong", ...

std::string conform_json(const Judgement& judgement);
std::string conform_junit(const Judgement& judgement);
Result<std::string> conform_page(const Judgement& judgement, const ConformFolder& folder, const ConformPictures& pictures,
                                 ConformDrawer& drawer, const Jobs& jobs);

// Returns the error of pictures that are not all right.
Error conform_error(const Judgement& judgement);

} // namespace burnish
