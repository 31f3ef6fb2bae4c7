"""What holds for all tests: nothing comes from results that earlier runs kept, unless a test asks for it."""

import os

os.environ["VDS_CACHE_MIB"] = "0"
