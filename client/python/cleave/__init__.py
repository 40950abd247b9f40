"""Client of the Cleave fracture simulator."""
