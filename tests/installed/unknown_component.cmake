find_package(roadbed REQUIRED COMPONENTS lanes)
