#include "shading/bake/environment.h"
