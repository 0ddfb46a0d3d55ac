"""The CAN matrix in Excel: written, and read back."""
