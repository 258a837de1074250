#include "render/brdf/normalise.h"

#include "config/memory.h"
#include "render/env/cube.h"

#include <math.h>
#include <stdlib.h>
