#include "core/base/version.h"

namespace burnish {
const char* version()
{
    return BN_VERSION;
}
} // namespace burnish
