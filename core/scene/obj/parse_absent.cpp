#include "core/scene/obj/parse.h"

namespace burnish::obj {

Parsed parse(const std::string& path, const std::string&)
{
    Parsed parsed;
    parsed.wrong = Error{ExitCode::bad_input, path, "", "this program was built without a reader of OBJ files"};
    return parsed;
}

} // namespace burnish::obj
