#!/usr/bin/perl
# Faults that are put into the sources, to see that a test notices them.
#
#   mutate.pl check LIST      each fault of the list stands exactly once
#   mutate.pl put LIST LINE   puts the fault of this line into its source and
#                             prints the name of the file
#
# A line of the list:  FUNCTION @@ OLD @@ NEW @@ by KILLER
#   FUNCTION  a function or a table; FILE.c:FUNCTION, where several files have
#             one of this name
#   OLD       a piece of its text, whole words, however it is spaced; it stands
#             there exactly once, so the shortest that does is the best
#   NEW       what stands there instead
#   KILLER    the suite or check that notices it
use strict;
use warnings;

sub read_file {
    my ($name) = @_;
    open(my $file, '<', $name) or die "$name: $!\n";
    local $/;
    return scalar <$file>;
}

# Begin and end of what a name defines in a text; an empty list: nothing.
sub definition {
    my ($text, $name) = @_;
    return () if index($text, $name) < 0;
    # A function may be EACH(name), or KERNEL(name, 1).
    my $head = qr/^(?![\s#\/*}])[^;{}=]*?(?<![\w.>])\Q$name\E\b/m;
    if ($text =~ /$head(?:\)?\s*\([^;{]*|, \d+)\)\s*\{.*?\n\}/ms) {
        return ($-[0], $+[0]); # a function
    }
    if ($text =~ /$head[^;(){}=]*=\s*\{.*?\n\};/ms) {
        return ($-[0], $+[0]); # a table
    }
    return ();
}

# An expression for a piece of text, however it is spaced.
sub piece {
    my ($old) = @_;
    my ($expression, $last) = ('', '');
    for my $token ($old =~ /\w+|[^\w\s]/g) {
        my $apart = $last =~ /\w$/ && $token =~ /^\w/ ? '\s+' : '\s*';
        $expression .= ($last eq '' ? '' : $apart) . quotemeta($token);
        $last = $token;
    }
    $expression = '(?<!\w)' . $expression if $old =~ /^\w/;
    $expression .= '(?!\w)' if $old =~ /\w$/;
    return qr/$expression/;
}

my %sources = map { $_ => read_file($_) }
    glob('src/*.[ch] src/*/*.[ch] src/*/*.inc include/*/*.h');

# Where a fault stands: file, begin, end; or one text, why it does not.
sub find_fault {
    my ($function, $old) = @_;
    my ($file, $name) = $function =~ /^(?:(\S+):)?(\w+)$/;
    my $expression = piece($old);
    my (@found, $defined);
    for my $source (sort keys %sources) {
        next if $file && $source !~ m{/\Q$file\E$};
        my ($begin, $end) = definition($sources{$source}, $name);
        next unless defined $begin;
        $defined = 1;
        my $body = substr($sources{$source}, $begin, $end - $begin);
        while ($body =~ /$expression/g) {
            push @found, [$source, $begin + $-[0], $begin + $+[0]];
        }
    }
    return "nothing is called $function" unless $defined;
    return "$function has no '$old' any more" unless @found;
    return "$function has '$old' " . @found . ' times' if @found > 1;
    return @{ $found[0] };
}

my ($command, $list, $chosen) = @ARGV;
die "usage: mutate.pl check|put LIST [LINE]\n" unless $list;
my ($number, $bad) = (0, 0);
for my $line (split(/\n/, read_file($list))) {
    $number++;
    next if $line =~ /^(#.*)?$/ || ($chosen && $number != $chosen);
    my @field = map { s/^\s+|\s+$//gr } split(/ @@(?= |$)/, $line, -1);
    my @where = @field == 4 ? find_fault(@field[0, 1]) : 'not four fields';
    if (@where == 1) {
        print "$list:$number: $where[0]: say what it is called now, ",
            "or delete the line\n";
        $bad = 1;
    } elsif ($command eq 'put') {
        my ($name, $begin, $end) = @where;
        my $text = $sources{$name};
        substr($text, $begin, $end - $begin) = $field[2];
        open(my $file, '>', $name) or die "$name: $!\n";
        print $file $text;
        close($file) or die "$name: $!\n";
        print "$name\n";
    }
}
exit $bad;
