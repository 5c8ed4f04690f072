"""The rough surface as one field of heights: the theory as plain functions of numbers.

`spectrum` gives the autocorrelation and its powers, `programme` the greatest value of the energy,
`table` what ships of it, `formulas` load and area from that.
"""
