# The find_package(Tandem) package.
