"""What can happen to a file that a run has written."""


def missing(file):
    file.unlink()


def empty(file):
    file.write_bytes(b"")


def truncated(file):
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])


def flipped(file):
    """One bit in the middle."""
    contents = bytearray(file.read_bytes())
    contents[len(contents) // 2] ^= 4
    file.write_bytes(contents)


def another_number(file):
    """In the middle of a number: still JSON, and another answer."""
    contents = bytearray(file.read_bytes())
    digits = [i for i, byte in enumerate(contents) if chr(byte).isdecimal()]
    contents[digits[len(digits) // 2]] ^= 1
    file.write_bytes(contents)
