#include "shading/bake/texture.h"
