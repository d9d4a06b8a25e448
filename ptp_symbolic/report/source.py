"""The source document that the reports cite by its equations, tables and figures."""

# The copy that the project works from gives title, date and supervisor, and no author.
THESIS = (
    r"\emph{Multi-Domain Modeling of Pan Tilt Platform with Mechanical Imperfections}, thesis,"
    r" August 2013, supervised by Dr.~Waheed Ul Haq Syed (its author is not named in the copy used"
    r" here)."
)
